// Ways to spoil a clean frame, each with what an exact check must find then.
#pragma once

#include <set>
#include <string>

#include "tests/verify/sheet.h"

namespace selvage::verify::testbed {

using selvage::testing::add_vertex;
using selvage::testing::point_on;

inline std::string text(const Violation& v) {
  const char* events[] = {"vf", "ee", "overlap", "self"};
  return std::string(events[static_cast<std::size_t>(v.event)]) + " " + v.kind + " " + std::to_string(v.features[0]) +
         " " + std::to_string(v.features[1]);
}

inline std::set<std::string> texts(const CheckResult& result) {
  std::set<std::string> names;
  for (const Violation& v : result.violations) names.insert(text(v));
  return names;
}

/// One way to spoil a clean sheet at one face, and the names of what must be found then.
struct Plant {
  const char* why;
  std::set<std::string> (*spoil)(io::MeshData&, std::size_t face);
};

inline std::string overlap_name(const char* kind, std::size_t face, const io::MeshData& mesh) {
  return std::string("overlap ") + kind + " " + std::to_string(face) + " " + std::to_string(mesh.triangles.size() - 1);
}

inline const Plant kPlants[] = {
    {"a triangle pierces a face",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}, 0.0625));
       const auto q = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}, -0.0625));
       const auto r = add_vertex(mesh, point_on(mesh, face, {1, 2, 1}, 0.0625));
       mesh.triangles.push_back({p, q, r});
       return std::set{overlap_name("cross", face, mesh)};
     }},
    {"a vertex touches the interior of a face",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}));
       const auto q = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}, 0.125));
       const auto r = add_vertex(mesh, point_on(mesh, face, {1, 2, 1}, 0.125));
       mesh.triangles.push_back({p, q, r});
       return std::set{overlap_name("touch", face, mesh)};
     }},
    {"a coplanar triangle inside a face",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}));
       const auto q = add_vertex(mesh, point_on(mesh, face, {1, 2, 1}));
       const auto r = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}));
       mesh.triangles.push_back({p, q, r});
       return std::set{overlap_name("overlap", face, mesh)};
     }},
    {"a triangle that shares a vertex pierces the face",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, 0.0625));
       const auto q = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, -0.0625));
       mesh.triangles.push_back({mesh.triangles[face][0], p, q});
       return std::set{overlap_name("cross", face, mesh)};
     }},
    {"a triangle that shares a vertex touches the face elsewhere",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}));
       const auto q = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, 0.0625));
       mesh.triangles.push_back({mesh.triangles[face][0], p, q});
       return std::set{overlap_name("touch", face, mesh)};
     }},
    {"a triangle that shares a vertex lies in the face",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {1, 2, 1}));
       const auto q = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}));
       mesh.triangles.push_back({mesh.triangles[face][0], p, q});
       return std::set{overlap_name("overlap", face, mesh)};
     }},
    {"a triangle that shares an edge is folded flat onto the face",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {1, 1, 2}));
       mesh.triangles.push_back({mesh.triangles[face][1], mesh.triangles[face][0], p});
       return std::set{overlap_name("fold", face, mesh)};
     }},
    {"the same face twice",
     [](io::MeshData& mesh, std::size_t face) {
       const auto [a, b, c] = mesh.triangles[face];
       mesh.triangles.push_back({b, a, c});
       // and each copy is folded onto nothing: neighbours share an edge with both and lie elsewhere
       return std::set{overlap_name("duplicate", face, mesh)};
     }},
    {"a zero-area face, away from the sheet",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, 2));
       const auto q = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, 3));
       const auto r = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, 4));
       mesh.triangles.push_back({p, r, q});
       return std::set{"self degenerate " + std::to_string(q) + " " + std::to_string(mesh.triangles.size() - 1)};
     }},
    {"a zero-area face pierces a face",
     [](io::MeshData& mesh, std::size_t face) {
       const auto p = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, -0.0625));
       const auto q = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, 1));
       const auto r = add_vertex(mesh, point_on(mesh, face, {2, 1, 1}, 2));
       mesh.triangles.push_back({p, r, q});
       return std::set{overlap_name("cross", face, mesh),
                       "self degenerate " + std::to_string(q) + " " + std::to_string(mesh.triangles.size() - 1)};
     }},
};

}  // namespace selvage::verify::testbed
