// The types that cross the kernel's border, with their shapes.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "kernel/sound_arithmetic.h"

// Eigen's matrices are allocated and aligned as the compiler's flags say (-march, -fsanitize): freed by code with other
// flags they crash. The library's CMake target tells its users, and itself, how it is built.
#ifdef SELVAGE_EIGEN_LAYOUT
static_assert(2 * EIGEN_DEFAULT_ALIGN_BYTES + EIGEN_MALLOC_ALREADY_ALIGNED == SELVAGE_EIGEN_LAYOUT,
              "selvage: this is compiled with other -march, -mavx or -fsanitize flags than the library, and Eigen's "
              "matrices differ; compile both with the same (cmake -DCMAKE_CXX_FLAGS=... builds the library so)");
#endif
static_assert(sizeof(EIGEN_DEFAULT_DENSE_INDEX_TYPE) == sizeof(std::int64_t),
              "selvage: Eigen's matrices count their rows in other integers than the library's; compile without "
              "-DEIGEN_DEFAULT_DENSE_INDEX_TYPE=...");

// Containers that check themselves are larger than those that do not.
#ifdef SELVAGE_CHECKED_CONTAINERS
#ifdef _GLIBCXX_DEBUG
static_assert(SELVAGE_CHECKED_CONTAINERS,
              "selvage: this is compiled with -D_GLIBCXX_DEBUG, and the library is not, so that std::vector differs; "
              "compile both with the same (cmake -DCMAKE_CXX_FLAGS=... builds the library so)");
#else
static_assert(!SELVAGE_CHECKED_CONTAINERS,
              "selvage: the library is compiled with -D_GLIBCXX_DEBUG, and this is not, so that std::vector differs; "
              "compile both with the same");
#endif
#endif

namespace selvage {

using VertexId = std::int32_t;                                                  ///< row of the positions
using EdgeId = std::int32_t;                                                    ///< place in Mesh::edges
using FaceId = std::int32_t;                                                    ///< row of the faces
using Vec3 = Eigen::Vector3d;                                                   ///< a point or a direction
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;    ///< #V by 3
using Faces = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;  ///< #F by 3
using PositionsRef = Eigen::Ref<const Positions>;                               ///< #V by 3
using FacesRef = Eigen::Ref<const Faces>;                                       ///< #F by 3

/// Largest |coordinate| in the domain. A difference of two such, squared norms after scaling, and every box stay
/// finite.
inline constexpr double kMaxCoordinate = 0x1p+1000;

/// The two kinds of pairs, and the third event of the guarantee: a vertex and the opposite edge of its own face.
enum class PairKind : std::uint8_t { kVf, kEe, kSelf };

}  // namespace selvage
