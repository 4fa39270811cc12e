// The floating-point environment that the proofs assume: round to nearest, no flush to zero, no denormals-are-zero, no
// traps.
#pragma once

namespace selvage {

/// Sets the environment for a scope and restores what it found, whatever was changed inside. Stands at every public
/// entry of the kernel and at the start of every worker task: a library linked with -ffast-math changes FTZ and DAZ of
/// the whole process.
class FpEnvGuard {
 public:
  FpEnvGuard() noexcept;
  ~FpEnvGuard();
  FpEnvGuard(const FpEnvGuard&) = delete;
  FpEnvGuard& operator=(const FpEnvGuard&) = delete;
  /// Whether the environment had to be repaired on entry.
  [[nodiscard]] bool repaired() const noexcept { return repaired_; }

 private:
  unsigned saved_;
  bool repaired_;
};

/// What can be wrong with a thread's floating-point environment.
enum FpEnvDefect : unsigned {
  kFpRounding = 1,    ///< not rounding to nearest
  kFpFlush = 2,       ///< subnormal results are flushed to zero
  kFpDenormals = 4,   ///< subnormal operands are taken as zero
  kFpContracted = 8,  ///< a * b + c is fused
  kFpNan = 16,        ///< NaN comparisons are broken
  kFpInfinity = 32,   ///< infinity comparisons are broken
  kFpExcess = 64,     ///< excess precision or reassociation
};

/// Probes the calling thread as it is, without repairing: 0, or an OR of FpEnvDefect.
[[nodiscard]] unsigned fp_env_defects() noexcept;

}  // namespace selvage
