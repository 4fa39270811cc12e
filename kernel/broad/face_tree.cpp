#include "kernel/broad/face_tree.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>

namespace selvage {

namespace {

using Node = std::int32_t;

struct Link {
  Node node;
  std::int32_t shared_edges;
};

/// The nodes of one sweep, in face order, and which of them are adjacent.
struct Level {
  std::vector<Node> tree_node;           ///< its number in the FaceTree
  std::vector<std::int32_t> face_count;  ///< faces below it
  std::vector<std::size_t> link_begin{0};
  std::vector<Link> links;

  [[nodiscard]] std::size_t size() const { return tree_node.size(); }
  [[nodiscard]] std::span<const Link> links_of(std::size_t i) const {
    return std::span(links).subspan(link_begin[i], link_begin[i + 1] - link_begin[i]);
  }
};

/// Appends the links of nodes one after another, uniting repeated ones.
class LinkWriter {
 public:
  explicit LinkWriter(Level& level) : level_(level), position_(level.size(), 0) {}
  void add(Node node, std::int32_t shared_edges) {
    std::size_t& position = position_[static_cast<std::size_t>(node)];
    if (position > level_.link_begin.back()) {  // positions count from 1; older ones belong to earlier nodes
      level_.links[position - 1].shared_edges += shared_edges;
    } else {
      level_.links.push_back({node, shared_edges});
      position = level_.links.size();
    }
  }
  void finish_node() { level_.link_begin.push_back(level_.links.size()); }

 private:
  Level& level_;
  std::vector<std::size_t> position_;
};

Level face_level(const Mesh& mesh) {
  const std::size_t face_count = mesh.faces.size();
  // The faces around every edge in order, as a ring of "next" and "previous" per side of a face.
  std::vector<std::int32_t> last_side(mesh.edges.size(), -1), next(3 * face_count, -1), previous(3 * face_count, -1);
  for (std::size_t side = 0; side < 3 * face_count; ++side) {
    std::int32_t& last = last_side[static_cast<std::size_t>(mesh.face_edges[side / 3][side % 3])];
    previous[side] = last;
    if (last >= 0) next[static_cast<std::size_t>(last)] = static_cast<std::int32_t>(side);
    last = static_cast<std::int32_t>(side);
  }
  Level level;
  level.tree_node.resize(face_count);
  std::iota(level.tree_node.begin(), level.tree_node.end(), 0);
  level.face_count.assign(face_count, 1);
  LinkWriter writer(level);
  for (std::size_t f = 0; f < face_count; ++f) {
    for (std::size_t side = 3 * f; side < 3 * f + 3; ++side) {
      for (const std::int32_t other : {previous[side], next[side]}) {
        if (other >= 0) writer.add(other / 3, 1);
      }
    }
    writer.finish_node();
  }
  return level;
}

/// The partner of every node in this sweep, or -1.
class Sweep {
 public:
  Sweep(const Level& level, bool backwards) : level_(level), order_(level.size()), partner_(level.size(), -1) {
    std::iota(order_.begin(), order_.end(), Node{0});
    if (backwards) std::reverse(order_.begin(), order_.end());
    for (const Node node : order_) {
      if (is_free(node)) pair_with_neighbour(node);
    }
    if (2 * paired_ < level.size()) pair_across_a_neighbour();
    pair_lonely();
  }
  [[nodiscard]] const std::vector<Node>& partner() const { return partner_; }

 private:
  [[nodiscard]] bool is_free(Node node) const { return partner_[static_cast<std::size_t>(node)] < 0; }
  [[nodiscard]] std::span<const Link> links_of(Node node) const {
    return level_.links_of(static_cast<std::size_t>(node));
  }
  void pair(Node a, Node b) {
    partner_[static_cast<std::size_t>(a)] = b;
    partner_[static_cast<std::size_t>(b)] = a;
    paired_ += 2;
  }
  void pair_with_neighbour(Node node) {
    const auto rank = [&](const Link& link) {
      return std::tuple(-link.shared_edges, level_.face_count[static_cast<std::size_t>(link.node)], link.node);
    };
    const Link* best = nullptr;
    for (const Link& link : links_of(node)) {
      if (is_free(link.node) && (best == nullptr || rank(link) < rank(*best))) best = &link;
    }
    if (best != nullptr) pair(node, best->node);
  }
  /// Afterwards every free node that has neighbours waits alone at one of them, which is not free.
  void pair_across_a_neighbour() {
    std::vector<Node> waiting(level_.size(), -1);
    for (const Node node : order_) {
      if (!is_free(node)) continue;
      for (const Link& link : links_of(node)) {
        const Node other = waiting[static_cast<std::size_t>(link.node)];
        if (other >= 0 && is_free(other)) {
          pair(node, other);
          break;
        }
        waiting[static_cast<std::size_t>(link.node)] = node;
      }
    }
  }
  void pair_lonely() {
    Node lonely = -1;
    for (const Node node : order_) {
      if (!is_free(node) || !links_of(node).empty()) continue;
      if (lonely >= 0) {
        pair(lonely, node);
        lonely = -1;
      } else {
        lonely = node;
      }
    }
  }

  const Level& level_;
  std::vector<Node> order_, partner_;
  std::size_t paired_ = 0;
};

/// The next level: a node for every pair and every free node, in the order of their first members.
Level contract(const Level& level, const std::vector<Node>& partner, FaceTree& tree, Node& tree_size) {
  Level next;
  std::vector<Node> parent(level.size());
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < level.size(); ++i) {
    const auto mate = static_cast<std::size_t>(partner[i] < 0 ? static_cast<Node>(i) : partner[i]);
    if (mate < i) {
      parent[i] = parent[mate];
      continue;
    }
    parent[i] = static_cast<Node>(first.size());
    first.push_back(i);
    if (mate == i) {
      next.tree_node.push_back(level.tree_node[i]);
      next.face_count.push_back(level.face_count[i]);
    } else {
      tree.children.push_back({level.tree_node[i], level.tree_node[mate]});
      next.tree_node.push_back(tree_size++);
      next.face_count.push_back(level.face_count[i] + level.face_count[mate]);
    }
  }
  LinkWriter writer(next);
  for (std::size_t node = 0; node < first.size(); ++node) {
    const std::size_t i = first[node];
    for (const Node member : {static_cast<Node>(i), partner[i]}) {
      if (member < 0) continue;
      for (const Link& link : level.links_of(static_cast<std::size_t>(member))) {
        const Node to = parent[static_cast<std::size_t>(link.node)];
        if (to != static_cast<Node>(node)) writer.add(to, link.shared_edges);
      }
    }
    writer.finish_node();
  }
  return next;
}

}  // namespace

FaceTree make_face_tree(const Mesh& mesh) {
  FaceTree tree;
  Node tree_size = static_cast<Node>(mesh.faces.size());
  Level level = face_level(mesh);
  for (bool backwards = false; level.size() > 1; backwards = !backwards) {
    level = contract(level, Sweep(level, backwards).partner(), tree, tree_size);
  }
  return tree;
}

}  // namespace selvage
