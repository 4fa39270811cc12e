// Replays in words and as JSON.
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/answer/replay.h"
#include "io/file/text.h"
#include "verify/report/report.h"

namespace selvage::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* sentence(ReplayOutcome outcome) {
  switch (outcome) {
    case ReplayOutcome::kAgree:
      return "no promise is broken";
    case ReplayOutcome::kBroken:
      return "A PROMISE IS BROKEN";
    case ReplayOutcome::kOutside:
      return "OUTSIDE THE DOMAIN: nothing is promised";
    case ReplayOutcome::kContradicted:
      return "THE FILE EXPECTS ANOTHER ANSWER";
    case ReplayOutcome::kDivided:
      return "THE TWO EXACT DECIDERS DISAGREE";
  }
  return "unknown";
}

const char* name_of(ReplayOutcome outcome) {
  switch (outcome) {
    case ReplayOutcome::kAgree:
      return "agree";
    case ReplayOutcome::kBroken:
      return "broken";
    case ReplayOutcome::kOutside:
      return "outside";
    case ReplayOutcome::kContradicted:
      return "contradicted";
    case ReplayOutcome::kDivided:
      return "divided";
  }
  return "unknown";
}

const char* name_of(CcdVerdict verdict) {
  switch (verdict) {
    case CcdVerdict::kSeparated:
      return "separated";
    case CcdVerdict::kCollides:
      return "collides";
    case CcdVerdict::kUnresolved:
      return "unresolved";
  }
  return "unknown";
}

const char* name_of(CcdCause cause) {
  switch (cause) {
    case CcdCause::kNone:
      return "none";
    case CcdCause::kMotion:
      return "motion";
    case CcdCause::kEnd:
      return "end";
  }
  return "unknown";
}

const char* name_of(verify::MotionKind kind) {
  switch (kind) {
    case verify::MotionKind::kNone:
      return "none";
    case verify::MotionKind::kTouch:
      return "touch";
    case verify::MotionKind::kCross:
      return "cross";
  }
  return "unknown";
}

const char* title(PairKind kind) {
  switch (kind) {
    case PairKind::kVf:
      return "vertex-face motion";
    case PairKind::kEe:
      return "edge-edge motion";
    case PairKind::kSelf:
      return "vertex against the opposite edge of its own face";
  }
  return "unknown";
}

const char* sign_name(int sign) { return sign < 0 ? "-" : sign > 0 ? "+" : "0"; }

std::string text_of(const verify::ExactTime& t) {
  if (t.lower == t.upper) return fmt::format("t = {} ({:.17g})", t.lower, t.lower_approx);
  return fmt::format("t in ({}, {}) (about {:.17g})", t.lower, t.upper, t.lower_approx);
}

Json json_of(const verify::ExactTime& t) {
  return {{"lower", t.lower}, {"upper", t.upper}, {"lower_number", t.lower_approx}, {"upper_number", t.upper_approx}};
}

/// The words for what was kept and was not asked now.
std::string unasked_text(const fuzz::PluginRecord& record, const std::string& name) {
  return fmt::format(
      "  plugin:   {} failed with '{}' when this was kept, and was not asked now: Selvage's own kernel was\n"
      "            ask it with: selvage replay --plugin {} {}\n",
      io::printable(record.library), record.failure, io::printable(io::shell_word(record.library)),
      io::printable(io::shell_word(name)));
}

std::string plugin_text(const fuzz::PluginTrial& plugin, const MotionReplay& replay) {
  std::string text = "no answer";
  if (plugin.has_answer) text = fuzz::words_of(plugin.answer, plugin.info.has_toi);
  if (plugin.has_answer && plugin.info.has_toi && plugin.answer.verdict == SELVAGE_COLLIDES) {
    text += fmt::format(" ({:.17g})", plugin.answer.toi);
    if (replay.exact.touches) {
      const bool is_early = replay.exact.first.lower_approx >= plugin.answer.toi;
      const double early =
          (is_early ? replay.exact.first.upper_approx : replay.exact.first.lower_approx) - plugin.answer.toi;
      text += fmt::format(", {:.6g} of the step {} the first touch", std::abs(early), early < 0 ? "behind" : "before");
    }
  }
  text = fmt::format("  plugin:   {}: {}: {}\n", plugin.info.name, text,
                     plugin.failure.empty() ? "conforms" : "FAILS: " + plugin.failure);
  if (!plugin.difference.empty()) text += "            " + plugin.difference + "\n";
  if (replay.kept.plugin && replay.kept.plugin->failure != (plugin.failure.empty() ? "none" : plugin.failure)) {
    text += fmt::format("            it was kept for '{}'{}\n", replay.kept.plugin->failure,
                        plugin.failure.empty()
                            ? ": the library has changed since, or its answer depends on what it was asked before"
                            : "");
  }
  return text;
}

Json number_and_bits(double x) { return {{"number", x}, {"hex", fmt::format("{:a}", x)}}; }

Json plugin_json(const MotionReplay& replay) {
  if (!replay.plugin && !replay.kept.plugin) return nullptr;
  Json json = {{"library", nullptr}, {"kept_for", nullptr}, {"name", nullptr},
               {"verdict", nullptr}, {"toi", nullptr},      {"failure", nullptr}};
  if (replay.kept.plugin) {
    json["library"] = replay.kept.plugin->library;
    json["kept_for"] = replay.kept.plugin->failure;
  }
  if (!replay.plugin) return json;
  const fuzz::PluginTrial& plugin = *replay.plugin;
  json["name"] = plugin.info.name;
  json["failure"] = plugin.failure.empty() ? "none" : plugin.failure;
  if (!plugin.has_answer) return json;
  const bool collides = plugin.answer.verdict == SELVAGE_COLLIDES;
  json["verdict"] = collides ? "collides" : "separated";
  if (collides && plugin.info.has_toi) json["toi"] = number_and_bits(plugin.answer.toi);
  return json;
}

std::string text_of(const verify::ExplainedPolynomial& polynomial) {
  std::string text = fmt::format("  {}: ", polynomial.name);
  if (polynomial.is_zero) return text + "vanishes for all t\n";
  text += "Bernstein coefficients";
  for (const std::string& coefficient : polynomial.bernstein) text += " " + coefficient;
  text += "\n    about";
  for (const double coefficient : polynomial.approx) text += fmt::format(" {:.6g}", coefficient);
  text +=
      fmt::format("; sign {} at t = 0, {} at t = 1\n", sign_name(polynomial.sign_t0), sign_name(polynomial.sign_t1));
  if (polynomial.roots.empty()) text += "    no root inside\n";
  for (const verify::ExactTime& root : polynomial.roots) text += "    root " + text_of(root) + "\n";
  return text;
}

Json json_of(const verify::ExplainedPolynomial& polynomial) {
  Json roots = Json::array();
  for (const verify::ExactTime& root : polynomial.roots) roots.push_back(json_of(root));
  return {{"name", polynomial.name},
          {"bernstein", polynomial.bernstein},
          {"approx", polynomial.approx},
          {"is_zero", polynomial.is_zero},
          {"sign_t0", polynomial.sign_t0},
          {"sign_t1", polynomial.sign_t1},
          {"roots", roots}};
}

std::string exact_text(const verify::MotionAnswer& exact) {
  return exact.touches ? fmt::format("{} first at {}", name_of(exact.kind), text_of(exact.first)) : "apart for all t";
}

std::string kernel_text(const CcdResult& kernel) {
  std::string text = name_of(kernel.verdict);
  if (kernel.verdict == CcdVerdict::kSeparated) return fmt::format("{} ({} intervals)", text, kernel.intervals);
  return fmt::format("{} (cause: {}), no touch before t = {:.17g} ({:a}), within {:.6g} ({} intervals)", text,
                     name_of(kernel.cause), kernel.toi_lower, kernel.toi_lower, kernel.gap_bound, kernel.intervals);
}

std::string textbook_text(const MotionReplay& replay) {
  if (!replay.textbook) return "has no such query";
  const std::string text = replay.textbook->collides ? fmt::format("collides at t = {:.17g}", replay.textbook->toi)
                                                     : std::string("separated");
  if (replay.textbook->collides == replay.exact.touches) return text;
  return text + (replay.exact.touches ? ": A MISS" : ": a false alarm");
}

std::string property_text(const MotionReplay& replay) {
  if (!replay.is_in_domain) return "not judged, and no plugin asked: a coordinate is beyond 2^1000";
  return replay.failure.empty() ? "holds" : replay.failure;
}

}  // namespace

Explanation explain(const std::string& name, const MotionReplay& replay) {
  Explanation result{name, {}, {}, replay.outcome()};
  result.text = fmt::format("{}: {} (from {})\n", io::printable(name), title(replay.kept.query.kind), replay.kept.seed);
  result.text += fmt::format("  exact:    {}\n", exact_text(replay.exact));
  result.text += fmt::format("  second:   {}\n", replay.second.touches
                                                     ? fmt::format("touches first at t in [{:.17g}, {:.17g}]",
                                                                   replay.second.first_lower, replay.second.first_upper)
                                                     : std::string("apart for all t"));
  result.text += fmt::format("  kernel:   {}\n", kernel_text(replay.kernel));
  result.text += fmt::format("  textbook: {}\n", textbook_text(replay));
  if (replay.plugin) result.text += plugin_text(*replay.plugin, replay);
  for (const auto& polynomial : replay.polynomials) result.text += text_of(polynomial);
  result.text += fmt::format("  property: {}: {}\n", replay.kept.property, property_text(replay));
  const fuzz::Disagreement disagreement = replay.judgement.disagreement;
  if (replay.kept.plugin && !replay.plugin) result.text += unasked_text(*replay.kept.plugin, name);
  result.text += fmt::format("  {}", sentence(result.outcome));
  if (disagreement != fuzz::Disagreement::kNone) result.text += fmt::format(" ({})", fuzz::name_of(disagreement));
  const bool is_plugins = replay.plugin && !replay.plugin->failure.empty();
  if (is_plugins) result.text += fmt::format(" (by the plugin: {})", replay.plugin->failure);
  if (replay.kept.plugin && !replay.plugin) result.text += " by Selvage's own kernel";
  result.text += "\n";

  Json json = {{"case", name},
               {"kind", fuzz::name_of(replay.kept.query.kind)},
               {"seed", replay.kept.seed},
               {"expected", replay.kept.touches ? "touches" : "apart"},
               {"exact", {{"touches", replay.exact.touches}, {"kind", name_of(replay.exact.kind)}, {"t", nullptr}}},
               {"second", {{"touches", replay.second.touches}}},
               {"kernel",
                {{"verdict", name_of(replay.kernel.verdict)},
                 {"cause", name_of(replay.kernel.cause)},
                 {"toi_lower", number_and_bits(replay.kernel.toi_lower)},
                 {"gap_bound", number_and_bits(replay.kernel.gap_bound)},
                 {"intervals", replay.kernel.intervals}}},
               {"textbook", nullptr},
               {"plugin", plugin_json(replay)},
               {"polynomials", Json::array()},
               {"disagreement", fuzz::name_of(disagreement)},
               {"property", replay.kept.property},
               {"failure", replay.failure.empty() ? "none" : replay.failure},
               {"outcome", name_of(result.outcome)}};
  if (replay.exact.touches) json["exact"]["t"] = json_of(replay.exact.first);
  if (replay.textbook) {
    json["textbook"] = {{"collides", replay.textbook->collides}, {"toi", number_and_bits(replay.textbook->toi)}};
  }
  for (const auto& polynomial : replay.polynomials) json["polynomials"].push_back(json_of(polynomial));
  result.json = json.dump(1, ' ', false, Json::error_handler_t::replace);
  return result;
}

Explanation explain(const std::string& name, const OverlapReplay& replay) {
  Explanation result{name, {}, {}, replay.outcome()};
  const char* exact = verify::name_of(replay.exact);
  result.text = fmt::format("{}: two triangles at one instant (from {})\n", io::printable(name), replay.kept.seed);
  result.text += fmt::format("  exact:    {}\n", exact);
  result.text += fmt::format("  second:   {}\n", replay.second ? "they meet beyond what they share"
                                                               : "they share no more than their common vertices");
  result.text += fmt::format("  {}\n", sentence(result.outcome));
  const Json json = {{"case", name},
                     {"kind", "overlap"},
                     {"seed", replay.kept.seed},
                     {"expected", replay.kept.touches ? "touches" : "apart"},
                     {"faces", replay.kept.faces},
                     {"positions", replay.kept.x},
                     {"exact", {{"touches", replay.exact != verify::OverlapKind::kNone}, {"kind", exact}}},
                     {"second", {{"touches", replay.second}}},
                     {"outcome", name_of(result.outcome)}};
  result.json = json.dump(1, ' ', false, Json::error_handler_t::replace);
  return result;
}

Explanation explain(const std::string& name, const KeptReplay& replay) {
  const auto& [parsed, retrial] = replay;
  Explanation result{name, {}, {}, replay.outcome()};
  result.text = fmt::format("{}: {} (from {})\n", io::printable(name), parsed.kept->kind(), parsed.origin);
  result.text += fmt::format("  promise:  {}\n  kept for: {}\n", parsed.kept->promise(), parsed.failure);
  for (const std::string& fact : retrial.facts) result.text += fmt::format("  {}\n", fact);
  result.text += fmt::format("  {}", sentence(result.outcome));
  if (!retrial.failure.empty()) result.text += fmt::format(" ({})", retrial.failure);
  result.text += "\n";
  const Json json = {{"case", name},
                     {"kind", parsed.kept->kind()},
                     {"seed", parsed.origin},
                     {"promise", parsed.kept->promise()},
                     {"kept_for", parsed.failure},
                     {"facts", retrial.facts},
                     {"failure", retrial.failure.empty() ? "none" : retrial.failure},
                     {"outcome", name_of(result.outcome)}};
  result.json = json.dump(1, ' ', false, Json::error_handler_t::replace);
  return result;
}

}  // namespace selvage::cli
