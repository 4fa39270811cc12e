#include "sim/base/conjugate_gradients.h"

#include <limits>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "sim/base/parallel.h"
#include "tests/vector_units.h"

namespace selvage::sim {
namespace {

constexpr std::int32_t kManyIterations = 1000;

/// A grid with diagonals on one side of a middle row, whose vertices also know the first: runs, single neighbours, and
/// rows that see none.
std::vector<std::vector<VertexId>> neighbours_of(VertexId columns, VertexId rows) {
  const VertexId count = columns * rows;
  std::vector<std::vector<VertexId>> neighbours(static_cast<std::size_t>(count) + 1);
  const auto join = [&](VertexId a, VertexId b) {
    neighbours[static_cast<std::size_t>(a)].push_back(b);
    neighbours[static_cast<std::size_t>(b)].push_back(a);
  };
  for (VertexId i = 0; i < count; ++i) {
    if ((i + 1) % columns != 0) join(i, i + 1);
    if (i + columns < count) join(i, i + columns);
    if (i + columns + 1 < count && (i + 1) % columns != 0 && i < count / 2) join(i, i + columns + 1);
    if (i > 1 && i != columns && i / columns == rows / 2) join(i, 0);
  }
  return neighbours;
}

/// The same matrix twice.
struct System {
  BlockMatrix A;
  Eigen::MatrixXd dense;
  Positions rhs;
  std::vector<std::uint8_t> is_free;
};

System random_system(VertexId columns, VertexId rows) {
  const auto neighbours = neighbours_of(columns, rows);
  const auto count = static_cast<Eigen::Index>(neighbours.size());
  System system{BlockMatrix(neighbours), Eigen::MatrixXd::Zero(3 * count, 3 * count), Positions(count, 3),
                std::vector<std::uint8_t>(neighbours.size(), 1)};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(-1, 1);
  const auto dense = [](const SymmetricBlock& m) {
    return (Eigen::Matrix3d() << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5]).finished();
  };
  const auto add_diagonal = [&](VertexId i, const SymmetricBlock& block) {
    system.A.add_diagonal(i, block);
    system.dense.block<3, 3>(3 * i, 3 * i) += dense(block);
  };
  for (VertexId i = 0; i < count; ++i) {
    SymmetricBlock mass = {};
    add_identity(0.1, mass);
    add_outer(0.05, share(random), share(random), share(random), mass);
    add_diagonal(i, mass);
    for (const VertexId j : neighbours[static_cast<std::size_t>(i)]) {
      if (j < i) continue;
      const double x = share(random), y = share(random), z = share(random);
      SymmetricBlock spring = {}, opposite = {};
      add_outer(1, x, y, z, spring);
      add_outer(-1, x, y, z, opposite);
      add_diagonal(i, spring);
      add_diagonal(j, spring);
      system.A.add_off_diagonal(system.A.find(i, j), opposite);
      system.A.add_off_diagonal(system.A.find(j, i), opposite);
      system.dense.block<3, 3>(3 * i, 3 * j) += dense(opposite);
      system.dense.block<3, 3>(3 * j, 3 * i) += dense(opposite);
    }
    system.rhs.row(i) << share(random), share(random), share(random);
  }
  return system;
}

double largest_difference(const Positions& x, const Eigen::VectorXd& dense) {
  return (Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()) - dense).cwiseAbs().maxCoeff();
}

Eigen::VectorXd solve_densely(const System& system) {
  Eigen::MatrixXd dense = system.dense;
  Eigen::VectorXd rhs = Eigen::Map<const Eigen::VectorXd>(system.rhs.data(), system.rhs.size());
  for (std::size_t i = 0; i < system.is_free.size(); ++i) {
    if (system.is_free[i] != 0) continue;
    const auto row = 3 * static_cast<Eigen::Index>(i);
    dense.middleRows(row, 3).setZero();
    dense.middleCols(row, 3).setZero();
    dense.block<3, 3>(row, row).setIdentity();
    rhs.segment<3>(row).setZero();
  }
  return dense.llt().solve(rhs);
}

Positions solve(const System& system, double residual = 1e-13) {
  ConjugateGradients solver;
  Positions x;
  const auto result = solver.solve(system.A, nullptr, system.is_free, system.rhs, residual, kManyIterations, x);
  EXPECT_TRUE(result.definite);
  EXPECT_TRUE(result.converged) << result.iterations;
  return x;
}

/// A spring between two vertices that the matrix knows nothing of.
class OneSpring : public Coupling {
 public:
  OneSpring(Eigen::Index a, Eigen::Index b, double stiffness) : a_(a), b_(b), stiffness_(stiffness) {}
  void add_product(const LaneVectors& x, LaneVectors& result) const override {
    const Eigen::RowVector3d pull = stiffness_ * (x.row(b_) - x.row(a_));
    result.row(a_) -= pull;
    result.row(b_) += pull;
  }
  void add_diagonal(Eigen::Index i, SymmetricBlock& block) const override {
    if (i == a_ || i == b_) add_identity(stiffness_, block);
  }

 private:
  Eigen::Index a_, b_;
  double stiffness_;
};

}  // namespace

TEST(ConjugateGradients, SolveWhatADenseFactorisationSolves) {
  for (const auto& [columns, rows] : {std::pair<VertexId, VertexId>{1, 1}, {2, 3}, {8, 4}, {7, 11}, {13, 9}}) {
    System system = random_system(columns, rows);
    EXPECT_LT(largest_difference(solve(system), solve_densely(system)), 1e-9) << columns << " x " << rows;
    for (std::size_t i = 0; i < system.is_free.size(); i += 3) system.is_free[i] = 0;
    EXPECT_LT(largest_difference(solve(system), solve_densely(system)), 1e-9) << columns << " x " << rows << ", held";
  }
}

TEST(ConjugateGradients, ACouplingIsAPartOfTheMatrix) {
  System system = random_system(7, 11);
  const Eigen::Index a = 5, b = 60;
  const OneSpring spring(a, b, 3);
  ConjugateGradients solver;
  Positions x;
  EXPECT_TRUE(solver.solve(system.A, &spring, system.is_free, system.rhs, 1e-13, kManyIterations, x).converged);
  for (int k = 0; k < 3; ++k) {
    system.dense(3 * a + k, 3 * a + k) += 3;
    system.dense(3 * b + k, 3 * b + k) += 3;
    system.dense(3 * a + k, 3 * b + k) -= 3;
    system.dense(3 * b + k, 3 * a + k) -= 3;
  }
  EXPECT_LT(largest_difference(x, solve_densely(system)), 1e-9);
}

TEST(ConjugateGradients, SameBitsForAnyThreadsAndVectorUnits) {
  const System system = random_system(70, 60);
  ASSERT_GT(system.A.rows(), 3 * kParallelBlock);
  const Positions expected = solve(system, 1e-6);
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    testing::on_every_vector_unit([&](const char* unit) {
      EXPECT_EQ((solve(system, 1e-6).array() != expected.array()).count(), 0) << threads << " threads, " << unit;
    });
  }
}

TEST(ConjugateGradients, WhatLeavesTheRangeOfDoublesIsNoSolution) {
  const auto solve_identity = [](double scale, double rhs, Positions& x) {
    BlockMatrix A(std::vector<std::vector<VertexId>>(2));
    SymmetricBlock block = {};
    add_identity(scale, block);
    A.add_diagonal(0, block);
    A.add_diagonal(1, block);
    ConjugateGradients solver;
    return solver.solve(A, nullptr, std::vector<std::uint8_t>{1, 1}, Positions::Constant(2, 3, rhs), 1e-9,
                        kManyIterations, x);
  };
  Positions x;
  const auto beyond = solve_identity(1, 1e200, x);  // the square of the residual is
  EXPECT_TRUE(beyond.definite);
  EXPECT_FALSE(beyond.converged);
  for (const double unit : {1e104, 1e-110, 1e150, 1e-150}) {  // in which only the determinant is
    const auto result = solve_identity(unit, 3 * unit, x);
    EXPECT_TRUE(result.definite) << unit;
    EXPECT_TRUE(result.converged) << unit;
    EXPECT_LT((x.array() - 3).abs().maxCoeff(), 1e-12) << unit;
  }
}

TEST(ConjugateGradients, SaysWhatIsNotDefiniteAndWhatIsNotFinite) {
  System system = random_system(7, 11);
  ConjugateGradients solver;
  Positions x;
  system.rhs(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solver.solve(system.A, nullptr, system.is_free, system.rhs, 1e-9, kManyIterations, x).converged);
  system = random_system(7, 11);
  SymmetricBlock negative = {};
  add_identity(-20, negative);
  system.A.add_diagonal(40, negative);
  EXPECT_FALSE(solver.solve(system.A, nullptr, system.is_free, system.rhs, 1e-9, kManyIterations, x).definite);
  system = random_system(1, 1);
  system.A.clear_row(0);
  system.A.clear_row(1);
  system.A.add_diagonal(0, {1, 0, 0, 1, 0, 1});
  system.A.add_diagonal(1, {1, 0, 0, 1, 0, 1});
  const OneSpring apart(0, 1, -0.6);
  EXPECT_FALSE(solver.solve(system.A, &apart, system.is_free, system.rhs, 1e-9, kManyIterations, x).definite);
}

}  // namespace selvage::sim
