#include "sim/dynamics/contact_sweeps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace selvage::sim {
namespace {

/// Masses are alike up to this ratio. Vertices of one cloth, however its mass is shared out, differ by less where its
/// edges differ by less than 2.
constexpr double kAlike = 4;

/// Sweeps over the root of the ratio r. Between a body and a vertex r times as heavy a sweep leaves r / (1 + r) of what
/// is missing, so r sweeps would leave a third of what nothing else bears. Measured: less is enough, as a vertex lies
/// on several, and contacts begin with their loads. A square of 0.2 m on a veil of 0.3 m, 100 times as heavy, both of
/// 12 x 12 vertices, 4 mm thick, was at least 7.2 mm above the ground with one and at least 7.7 with two, of 8
/// (docs/measurements/stability.md).
constexpr double kSweepsOfRoot = 2;

/// Mean inverse mass of vertices, over the largest of the contact: as it is, and over their share of a cloth whose mass
/// its faces give to their corners, in which one at a corner of the cloth has a sixth of that of others.
struct Lightness {
  double of_vertices = 0, of_faces = 0;
};

/// Of those that can move from `begin` to `end`; zero where none can.
Lightness lightness_of(const Interaction& interaction, std::size_t begin, std::size_t end, const VertexFaces& faces) {
  Lightness sum;
  int count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double mobility = interaction.mobility[i];
    if (!(mobility > 0)) continue;
    ++count;
    sum.of_vertices += mobility;
    sum.of_faces += mobility * static_cast<double>(faces.of(interaction.vertices[i]).size());
  }
  return count == 0 ? sum : Lightness{sum.of_vertices / count, sum.of_faces / count};
}

/// Of the heavier feature to the lighter, the smaller of both kinds: a cloth whose mass is shared out equally or by its
/// faces is alike all over. At most 1 where a body takes part, or where both kinds disagree.
double mass_ratio(const RepulsionContact& contact, const VertexFaces& faces) {
  const std::size_t second = contact.kind == PairKind::kVf ? 1 : 2;
  const Lightness a = lightness_of(contact.interaction, 0, second, faces);
  const Lightness b = lightness_of(contact.interaction, second, 4, faces);
  if (!(a.of_vertices > 0 && b.of_vertices > 0)) return 1;
  return std::max(std::min(a.of_vertices / b.of_vertices, a.of_faces / b.of_faces),
                  std::min(b.of_vertices / a.of_vertices, b.of_faces / a.of_faces));
}

std::int32_t even(std::int32_t count) { return count / 2 * 2; }

/// More than `least`.
std::int32_t more_for(double ratio, std::int32_t least) {
  if (!(ratio > kAlike)) return 0;
  const double wanted = std::min(std::round(kSweepsOfRoot * std::sqrt(ratio)), double(kMaxUnlikeSweeps));
  return even(std::max(static_cast<std::int32_t>(wanted) - least, 0));
}

template <class Act>
void each_moving(const RepulsionContact& contact, const Act& act) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (contact.interaction.mobility[i] > 0) act(contact.interaction.vertices[i]);
  }
}

}  // namespace

std::vector<std::int32_t> contact_sweeps(std::span<const RepulsionContact> contacts, const VertexFaces& faces,
                                         std::int32_t least) {
  std::vector<std::int32_t> sweeps, most_more;  // by contact, and by vertex of the contacts that take more
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const std::int32_t more = more_for(mass_ratio(contacts[i], faces), least);
    if (more == 0) continue;
    sweeps.resize(contacts.size(), least);
    sweeps[i] = least + more;
    each_moving(contacts[i], [&](VertexId vertex) {
      const auto at = static_cast<std::size_t>(vertex);
      if (at >= most_more.size()) most_more.resize(at + 1, 0);
      most_more[at] = std::max(most_more[at], more);
    });
  }
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    each_moving(contacts[i], [&](VertexId vertex) {
      const auto at = static_cast<std::size_t>(vertex);
      if (at < most_more.size()) sweeps[i] = std::max(sweeps[i], least + even(most_more[at] / 2));
    });
  }
  return sweeps;
}

}  // namespace selvage::sim
