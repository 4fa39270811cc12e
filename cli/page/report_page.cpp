#include "cli/page/report_page.h"

#include <fmt/format.h>

#include "cli/answer/case_output.h"
#include "cli/page/report_scene.h"
#include "cli/page/report_timeline.h"
#include "cli/page/report_words.h"
#include "page/assets.h"
#include "page/json.h"
#include "page/view_box.h"

namespace selvage::cli {

using page::element;
using page::Html;
using page::text;

namespace {

Html code(const std::string& plain) { return element("code", {}, text(plain)); }

Html header(const verify::SequenceReport& report, const verify::ReportContext& context) {
  const char* mark = report.verdict == verify::Verdict::kClean      ? "\u2713"
                     : report.verdict == verify::Verdict::kViolated ? "\u2715"
                                                                    : "?";
  std::string verdict = verify::name_of(report.verdict);
  const Html title = element("span", {{"class", "mark"}, {"aria-hidden", "true"}}, element("span", {}, text(mark))) +
                     element("h1", {{"id", "verdict"}}, text(verdict));
  Html all =
      element("p", {{"class", "kicker"}}, text(context.program + " verify ") + code(source_names(context.sources)));
  all += element("div", {{"class", "verdict " + verdict}}, title);
  all += element("p", {{"class", "lead"}}, text(verdict_sentence(report)));
  if (report.first_frame > 0 || report.end_frame < report.frame_count) {
    all += element("p", {},
                   text(fmt::format("A part: frames {} to {} of {}.", report.first_frame, report.end_frame - 1,
                                    grouped(report.frame_count))));
  }
  return all;
}

Html time_of(const verify::Violation& violation) {
  if (!violation.motion) return element("span", {{"class", "quiet"}}, text("one instant"));
  return element("span", {{"class", "number"}}, text(fmt::format("t = {:.6g}", violation.t.lower_approx)));
}

std::string command_of(const verify::Violation& violation) {
  return verify::replay_command(violation.case_file.empty() ? case_name(violation) : violation.case_file);
}

Html positions_of(const verify::Violation& violation) {
  page::Table table{"", {"vertex", "x", "y", "z"}, {}};
  for (std::size_t i = 0; i < violation.at_touch.size(); ++i) {
    std::vector<Html> row = {text(std::to_string(violation.vertices[i]))};
    for (const double x : violation.at_touch[i]) {
      row.push_back(element("span", {{"class", "number"}}, text(fmt::format("{}", x))));
    }
    table.rows.push_back(std::move(row));
  }
  return page::table(table);
}

/// The exact time, the positions then, and the command.
Html details_of(const verify::Violation& violation) {
  Html inside;
  if (violation.motion) {
    const auto& [lower, upper, lower_approx, upper_approx] = violation.t;
    const Html exact = lower == upper
                           ? text("First touch exactly at t = ") + code(lower)
                           : text("First touch at the only root in ") + code("(" + lower + ", " + upper + ")");
    inside += element("p", {}, exact);
  }
  inside += positions_of(violation) + element("p", {}, code(command_of(violation)));
  return element("details", {}, element("summary", {}, text("details")) + inside);
}

Html buttons_of(const verify::Violation& violation, std::size_t i) {
  const std::string command = command_of(violation);
  Html all = element("button", {{"type", "button"}, {"data-copy", command}, {"title", command}}, text("Copy"));
  if (violation.case_file.empty()) {
    all += Html{" "} + element("button",
                               {{"type", "button"}, {"data-case", std::to_string(i)}, {"title", case_name(violation)}},
                               text("Save"));
  }
  return all;
}

/// The rows carry what the script says above the view.
Html witness_table(const verify::SequenceReport& report) {
  Html head, body;
  for (const char* heading : {"", "where", "what", "first touch", "to reproduce"}) {
    head += element("th", {{"scope", "col"}}, text(heading));
  }
  for (std::size_t i = 0; i < report.violations.size(); ++i) {
    const verify::Violation& violation = report.violations[i];
    const std::string unit = unit_of(violation.frame, violation.motion), number = std::to_string(i + 1);
    const std::string title = fmt::format("{}, {}: {}", unit, features_of(violation), violation.kind);
    const Html button = element("button", {{"type", "button"}, {"aria-label", "Show witness " + number}}, text(number));
    const Html what = element("strong", {}, text(violation.kind)) + text(", " + features_of(violation));
    Html cells;
    for (const Html& cell :
         {button, text(unit), what + details_of(violation), time_of(violation), buttons_of(violation, i)}) {
      cells += element("td", {}, cell);
    }
    body += element("tr", {{"data-title", title}}, cells) + Html{"\n"};
  }
  return element("table", {{"id", "witnesses"}},
                 element("thead", {}, element("tr", {}, head)) + Html{"\n"} + element("tbody", {}, body));
}

Html witnesses(const verify::SequenceReport& report) {
  if (report.violations.empty()) return {};
  const std::int64_t left_out = report.violations_total.total() - std::ssize(report.violations);
  Html list = witness_table(report);
  if (left_out > 0) {
    list += element("p", {{"class", "quiet"}},
                    text(fmt::format("{} more are counted and not listed; --max-violations lists more.",
                                     counted(left_out, "violation"))));
  }
  return element("div", {{"class", "list"}}, list);
}

Html below_view(bool has_witnesses) {
  Html all =
      element("div", {{"id", "scrub"}, {"class", "scrub"}, {"hidden", ""}},
              element("button", {{"type", "button"}, {"data-do", "play"}}, text("Play")) +
                  element("div", {{"class", "track"}},
                          Html{"<input type=\"range\" min=\"0\" max=\"1\" step=\"any\" value=\"0\" "
                               "aria-label=\"Time in the motion\"><i class=\"touch\" title=\"first touch\"></i>"}) +
                  element("output", {}, {}));
  Html steps = element("strong", {{"id", "witness-title"}, {"role", "status"}}, {});
  if (has_witnesses) {
    steps = element("button", {{"type", "button"}, {"data-do", "previous"}}, text("Previous")) +
            element("button", {{"type", "button"}, {"data-do", "next"}}, text("Next")) + steps +
            element("span", {{"class", "quiet"}},
                    Html{"<i class=\"swatch first\"></i>first feature "
                         "<i class=\"swatch second\"></i>second feature"});
  }
  return all + element("div", {{"class", "bar"}}, steps);
}

Html about(const ReportScene& shown, const verify::SequenceReport& report, const verify::ReportContext& context,
           const ReportPageOptions& options) {
  const std::size_t frames = shown.scene.frame_count();
  std::string meshes = fmt::format("The meshes of {} of {} frames are in this page ({:.1f} MB)", frames,
                                   grouped(report.frame_count), static_cast<double>(shown.scene.bytes()) / 1e6);
  if (frames < shown.wanted) {
    meshes += fmt::format("; {} more with witnesses or in between did not fit into --html-mb {}", shown.wanted - frames,
                          options.scene_bytes / 1000000);
  }
  if (frames > 0) {
    meshes += fmt::format(". They are for looking at: positions are rounded to multiples of {:.3g}, witnesses are not",
                          shown.scene.grid_step());
  }
  Html all = element("p", {}, text(meshes + "."));
  if (shown.scene.moved_points() > 0) {
    all += element("p", {},
                   text(counted(shown.scene.moved_points(), "position") +
                        " too far from the cloth for the view are shown nearer."));
  }
  all += element("p", {},
                 text("Keys: n and p go to the next and previous witness, space plays a motion; in the view arrow keys "
                      "turn, + and - go nearer and farther, 0 shows the whole cloth."));
  Html asked;
  for (const auto& [name, value] : context.options) {
    if (!value.empty()) asked += element("div", {}, element("dt", {}, text(name)) + element("dd", {}, text(value)));
  }
  return all + element("dl", {{"class", "facts"}}, asked);
}

std::string cases_json(const verify::SequenceReport& report, double min_distance) {
  std::string json = "[";
  for (std::size_t i = 0; i < report.violations.size(); ++i) {
    const verify::Violation& violation = report.violations[i];
    json += fmt::format("{}{{\"name\": {}, \"text\": {}}}", i > 0 ? ",\n" : "", page::json_string(case_name(violation)),
                        page::json_string(case_text(violation, min_distance)));
  }
  return json + "]";
}

}  // namespace

std::string report_page(const verify::SequenceReport& report, const verify::ReportContext& context,
                        const io::SequenceReader* sequence, const ReportPageOptions& options) {
  const ReportScene shown = report_scene(report, sequence, options.scene_bytes);
  page::Page page(fmt::format("{}: {}", verify::name_of(report.verdict), source_names(context.sources)));
  page.add_header(header(report, context));
  page.add_header(element("div", {{"id", "left-out"}}, left_out(report, context.notes)));
  page.add_section("Timeline", report_timeline(report), "frames");
  const bool has_witnesses = !report.violations.empty();
  const Html view = page::view_box(page::UpAxis::kZ, below_view(has_witnesses));
  page.add_section(has_witnesses ? "Witnesses" : "View",
                   has_witnesses ? element("div", {{"class", "panes"}}, view + witnesses(report)) : view, "view");
  page.add_section("What was checked", facts(report), "facts");
  page.add_section("About this page", about(shown, report, context, options), "about");
  page.add_data("report", verify::json_report(report, context));
  page.add_data("cases", cases_json(report, options.min_distance));
  shown.scene.add_to(page);
  page::add_viewer(page);
  for (const char* script : {"scrubber.js", "timeline.js", "witnesses.js"}) page.add_script(page::asset(script));
  return page.html();
}

}  // namespace selvage::cli
