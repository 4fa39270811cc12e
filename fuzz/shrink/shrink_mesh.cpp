#include "fuzz/shrink/shrink_mesh.h"

#include <algorithm>
#include <cmath>

#include "fuzz/base/short_numbers.h"

namespace selvage::fuzz {
namespace {

void drop_loose_vertices(MeshCase& kept) {
  std::vector<std::int32_t> number(kept.vertex_count(), -1);
  for (const auto& face : kept.faces) {
    for (const std::int32_t corner : face) number[static_cast<std::size_t>(corner)] = 0;
  }
  std::int32_t next = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = next++;
    for (Positions& x : kept.x) x.row(number[v]) = Eigen::RowVector3d(x.row(static_cast<Eigen::Index>(v)));
    for (std::vector<double>& mark : kept.marks) mark[static_cast<std::size_t>(number[v])] = mark[v];
  }
  for (Positions& x : kept.x) x.conservativeResize(next, 3);
  for (std::vector<double>& mark : kept.marks) mark.resize(static_cast<std::size_t>(next));
  for (auto& face : kept.faces) {
    for (std::int32_t& corner : face) corner = number[static_cast<std::size_t>(corner)];
  }
}

class MeshShrinker {
 public:
  MeshShrinker(const MeshCase& kept, const std::string& failure, std::int64_t max_trials)
      : best_(kept), cost_(cost_of(kept)), failure_(failure), left_(max_trials) {}

  MeshCase run() {
    bool progress = true;
    while (progress && left_ > 0) {
      const MeshCost before = cost_;
      faces();
      numbers();
      instants();
      places();
      coordinates();
      rounding();
      progress = cost_ < before;
    }
    return best_;
  }

 private:
  bool offer(MeshCase simpler) {
    const MeshCost cost = cost_of(simpler);
    if (!(cost < cost_) || left_ <= 0) return false;
    --left_;
    const Retrial retrial = retry(simpler);
    if (!retrial.unfit.empty() || retrial.failure != failure_) return false;
    best_ = std::move(simpler);
    cost_ = cost;
    return true;
  }

  void faces() {
    for (std::size_t length = best_.faces.size() / 2; length > 0; length /= 2) {
      for (std::size_t end = best_.faces.size(); end >= length; --end) {
        if (end > best_.faces.size() || best_.faces.size() == length) continue;
        MeshCase simpler = best_;
        const auto last = simpler.faces.begin() + static_cast<std::ptrdiff_t>(end);
        simpler.faces.erase(last - static_cast<std::ptrdiff_t>(length), last);
        drop_loose_vertices(simpler);
        (void)offer(std::move(simpler));
      }
    }
  }

  void numbers() {
    for (std::size_t i = 0; i < best_.settings.size(); ++i) set_number(i, best_.kind->settings[i].simplest);
    for (std::size_t i = 0; i < best_.marks.size(); ++i) {
      MeshCase simpler = best_;
      std::ranges::fill(simpler.marks[i], best_.kind->marks[i].simplest);
      if (offer(std::move(simpler))) continue;
      for (std::size_t v = 0; v < best_.vertex_count(); ++v) {
        MeshCase one = best_;
        one.marks[i][v] = best_.kind->marks[i].simplest;
        (void)offer(std::move(one));
      }
    }
  }

  void set_number(std::size_t i, double x) {
    MeshCase simpler = best_;
    simpler.settings[i] = x;
    (void)offer(std::move(simpler));
  }

  /// Less motion: an instant is like another one, everywhere or at a vertex.
  void instants() {
    for (std::size_t to = 0; to < best_.x.size(); ++to) {
      for (std::size_t from = 0; from < best_.x.size(); ++from) {
        MeshCase simpler = best_;
        simpler.x[to] = simpler.x[from];
        if (offer(std::move(simpler))) continue;
        for (Eigen::Index v = 0; v < best_.x[0].rows(); ++v) {
          MeshCase one = best_;
          one.x[to].row(v) = one.x[from].row(v);
          (void)offer(std::move(one));
        }
      }
    }
  }

  /// The whole of it elsewhere, and of another size.
  void places() {
    for (Eigen::Index v = 0; v < best_.x[0].rows(); ++v) {
      const Eigen::RowVector3d origin = best_.x[0].row(v);
      MeshCase moved = best_;
      for (Positions& x : moved.x) x.rowwise() -= origin;
      (void)offer(std::move(moved));
    }
    const double largest = best_.x[0].cwiseAbs().maxCoeff();
    if (!(largest > 0) || !std::isfinite(largest)) return;
    for (int exponent = -std::ilogb(largest); exponent != 0; exponent /= 2) {
      MeshCase scaled = best_;
      for (Positions& x : scaled.x) {
        for (double& coordinate : x.reshaped()) coordinate = std::ldexp(coordinate, exponent);
      }
      if (offer(std::move(scaled))) return;
    }
  }

  void coordinates() {
    for (std::size_t i = 0; i < best_.x.size(); ++i) {
      for (Eigen::Index at = 0; at < best_.x[i].size(); ++at) {
        if (set(i, at, 0)) continue;
        MeshCase flat = best_;
        for (Positions& x : flat.x) x.reshaped()[at] = 0;
        if (offer(std::move(flat))) continue;
        (void)set(i, at, 1);
        for (std::size_t j = 0; j < best_.x.size(); ++j) (void)set(i, at, best_.x[j].reshaped()[at]);
      }
    }
  }

  void rounding() {
    for (const int bits : kShortBits) {  // all at once, then one by one
      MeshCase rounded = best_;
      for (Positions& x : rounded.x) {
        for (double& coordinate : x.reshaped()) coordinate = round_to_bits(coordinate, bits);
      }
      if (offer(std::move(rounded))) break;
    }
    for (std::size_t i = 0; i < best_.x.size(); ++i) {
      for (Eigen::Index at = 0; at < best_.x[i].size(); ++at) {
        for (const int bits : kShortBits) {
          if (set(i, at, round_to_bits(best_.x[i].reshaped()[at], bits))) break;
        }
      }
    }
  }

  bool set(std::size_t i, Eigen::Index at, double x) {
    MeshCase simpler = best_;
    simpler.x[i].reshaped()[at] = x;
    return offer(std::move(simpler));
  }

  MeshCase best_;
  MeshCost cost_;
  const std::string& failure_;
  std::int64_t left_;
};

}  // namespace

MeshCost cost_of(const MeshCase& kept) {
  MeshCost cost;
  cost.faces = kept.faces.size();
  cost.vertices = kept.vertex_count();
  for (std::size_t i = 0; i < kept.settings.size(); ++i) {
    cost.numbers += kept.settings[i] != kept.kind->settings[i].simplest ? 1 : 0;
  }
  for (std::size_t i = 0; i < kept.marks.size(); ++i) {
    for (const double mark : kept.marks[i]) cost.numbers += mark != kept.kind->marks[i].simplest ? 1 : 0;
  }
  for (const Positions& x : kept.x) {
    for (Eigen::Index at = 0; at < x.size(); ++at) {
      const double coordinate = x.reshaped()[at];
      cost.moving += coordinate != kept.x[0].reshaped()[at] ? 1 : 0;
      if (coordinate == 0) continue;
      ++cost.non_zero;
      cost.bits += mantissa_bits(coordinate);
      cost.exponents += std::isfinite(coordinate) ? std::abs(std::ilogb(coordinate)) : 0;
    }
  }
  return cost;
}

MeshCase shrink(const MeshCase& kept, const std::string& failure, std::int64_t max_trials) {
  return MeshShrinker(kept, failure, max_trials).run();
}

}  // namespace selvage::fuzz
