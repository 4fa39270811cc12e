#include "bench/query_methods.h"

#include <fmt/format.h>

#include "bench/additive_ccd.h"
#include "bench/inclusion_ccd.h"
#include "bench/textbook.h"
#include "kernel/ccd.h"

namespace selvage::bench {
namespace {

MethodAnswer additive_rescaled(const MethodQuery& query, double rescaling) {
  AdditiveOptions options;
  options.rescaling = rescaling;
  const auto ask = query.kind == PairKind::kVf ? additive_vf : additive_ee;
  const AdditiveAnswer answer = ask(query.x_t0, query.x_t1, options);
  return {answer.collides, answer.gave_up, answer.toi};
}

MethodAnswer inclusion_within(const MethodQuery& query, double tolerance) {
  InclusionOptions options;
  options.tolerance = tolerance;
  const auto ask = query.kind == PairKind::kVf ? inclusion_vf : inclusion_ee;
  const InclusionAnswer answer = ask(query.x_t0, query.x_t1, options);
  return {answer.collides, answer.gave_up, answer.toi};
}

}  // namespace

MethodQuery method_query(PairKind kind, const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1) {
  MethodQuery query{kind, x_t0, x_t1, {}, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    query.point_t0[i] = {x_t0[i].x(), x_t0[i].y(), x_t0[i].z()};
    query.point_t1[i] = {x_t1[i].x(), x_t1[i].y(), x_t1[i].z()};
  }
  return query;
}

MethodAnswer textbook_within(const MethodQuery& query, double tolerance) {
  const auto ask = query.kind == PairKind::kVf ? textbook_vf : textbook_ee;
  const TextbookAnswer answer = ask(query.x_t0, query.x_t1, tolerance);
  return {answer.collides, false, answer.toi};
}

MethodAnswer kernel_within(const MethodQuery& query, double tolerance) {
  CcdOptions options;
  options.tolerance = tolerance;
  const CcdResult result = pair_ccd(query.kind, query.x_t0, query.x_t1, options);
  return {result.verdict != CcdVerdict::kSeparated, result.verdict == CcdVerdict::kUnresolved, result.toi_lower};
}

MethodAnswer exact_decision(const MethodQuery& query) {
  return {exact_answer(query, verify::Detail::kDecision).touches};
}

verify::MotionAnswer exact_answer(const MethodQuery& query, verify::Detail detail) {
  return query.kind == PairKind::kVf ? verify::exact_vf_motion(query.point_t0, query.point_t1, detail)
                                     : verify::exact_ee_motion(query.point_t0, query.point_t1, detail);
}

std::vector<MethodSetting> method_settings() {
  std::vector<MethodSetting> settings;
  const auto add = [&](const char* method, const char* unit, auto ask, std::initializer_list<double> values) {
    for (const double value : values) {
      settings.push_back(
          {method, fmt::format("{}{}", value, unit), [ask, value](const MethodQuery& q) { return ask(q, value); }});
    }
  };
  add("textbook", " m", textbook_within, {1e-3, 1e-6, 1e-9, 1e-12});
  add("kernel", " m", kernel_within, {1e-3, 1e-6, 0.0});
  add("additive", "", additive_rescaled, {0.5, 0.9, 0.99, 0.999});
  add("inclusion", " of size", inclusion_within, {1e-2, 1e-4, 1e-6});
  settings.push_back({"exact", "", exact_decision, false});
  return settings;
}

}  // namespace selvage::bench
