#include "src/world/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>

#include "platform/base/command_line.hpp"
#include "src/world/action.hpp"
#include "src/world/path_measures.hpp"
#include "src/world/reactions.hpp"

namespace gannet::world {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = 3.14159265358979323846 / 180;
// At the goal: closer than this.
constexpr double kSettled_m = 0.020;
constexpr double kSettled_rad = 3 * kDegree;

bool inside(const TraceRow& row, const Window& window) {
  return row.time_s >= window.from_s && row.time_s <= window.until_s;
}

// The root of the mean square of what `of` says of each row; rows for which it says nothing do not
// count.
template <class Of>
double rms(const Trace& trace, const Window& window, Of of) {
  double sum = 0;
  int count = 0;
  for (const TraceRow& row : trace.rows) {
    if (!inside(row, window)) continue;
    const std::optional<double> value = of(row);
    if (!value) continue;
    sum += *value * *value;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNothing;
}

template <class Of>
double largest(const Trace& trace, const Window& window, Of of) {
  double most = kNothing;
  for (const TraceRow& row : trace.rows)
    if (inside(row, window)) most = std::fmax(most, of(row));
  return most;
}

template <int kAxis>
double rms_axis_mm(const Trace& trace, const Window& window) {
  return rms(trace, window,
             [](const TraceRow& row) { return std::optional<double>(1000 * row.error_m[kAxis]); });
}

double rms_mm(const Trace& trace, const Window& window) {
  return rms(trace, window,
             [](const TraceRow& row) { return std::optional<double>(1000 * row.error_m.norm()); });
}

double rms_yaw_deg(const Trace& trace, const Window& window) {
  return rms(trace, window,
             [](const TraceRow& row) { return std::optional<double>(row.error_rad / kDegree); });
}

double worst_mm(const Trace& trace, const Window& window) {
  return largest(trace, window, [](const TraceRow& row) { return 1000 * row.error_m.norm(); });
}

double worst_z_mm(const Trace& trace, const Window& window) {
  return largest(trace, window,
                 [](const TraceRow& row) { return 1000 * std::abs(row.error_m.z()); });
}

// The fastest way along the body's x in this sense, from row to row.
double fastest_mm_s(const Trace& trace, const Window& window, double sense) {
  double most = kNothing;
  const TraceRow* before = nullptr;
  for (const TraceRow& row : trace.rows) {
    if (!inside(row, window)) continue;
    if (before != nullptr) {
      const Eigen::Vector3d way = before->vehicle.rotation.conjugate() *
                                  (row.vehicle.translation - before->vehicle.translation);
      most = std::fmax(most, sense * 1000 * way.x() / (row.time_s - before->time_s));
    }
    before = &row;
  }
  return most;
}

double forward_mm_s(const Trace& trace, const Window& window) {
  return fastest_mm_s(trace, window, 1);
}

double backward_mm_s(const Trace& trace, const Window& window) {
  return fastest_mm_s(trace, window, -1);
}

bool settled(const TraceRow& row) {
  return row.error_m.norm() <= kSettled_m && std::abs(row.error_rad) <= kSettled_rad;
}

double settle_s(const Trace& trace, const Window& window) {
  const double start = std::max(window.from_s, trace.time_of("arm"));
  double since = kNothing;
  for (const TraceRow& row : trace.rows) {
    if (row.time_s < start || row.time_s > window.until_s) continue;
    if (!settled(row))
      since = kNothing;
    else if (std::isnan(since))
      since = row.time_s;
  }
  return since - start;
}

// Rows that bring a newly heard frame; others repeat what was heard before, or say that there was
// no frame (number 0).
template <class Visit>
void each_frame(const Trace& trace, const Window& window, Visit visit) {
  std::uint64_t last = 0;
  for (const TraceRow& row : trace.rows) {
    if (row.heard.frame == 0 || row.heard.frame == last) continue;
    last = row.heard.frame;
    if (inside(row, window)) visit(row);
  }
}

template <class Of>
double rms_found(const Trace& trace, const Window& window, Of of) {
  double sum = 0;
  int count = 0;
  each_frame(trace, window, [&](const TraceRow& row) {
    if (!row.heard.found) return;
    const double value = of(row);
    sum += value * value;
    ++count;
  });
  return count > 0 ? std::sqrt(sum / count) : kNothing;
}

template <int kAxis>
double estimate_axis_mm(const Trace& trace, const Window& window) {
  return rms_found(trace, window, [](const TraceRow& row) {
    return 1000 *
           (row.heard.left_from_target.translation[kAxis] - row.at_capture.translation[kAxis]);
  });
}

double estimate_deg(const Trace& trace, const Window& window) {
  return rms_found(trace, window, [](const TraceRow& row) {
    return row.heard.left_from_target.rotation.angularDistance(row.at_capture.rotation) / kDegree;
  });
}

double found_share(const Trace& trace, const Window& window) {
  int frames = 0, found = 0;
  each_frame(trace, window, [&](const TraceRow& row) {
    ++frames;
    found += row.heard.found;
  });
  return frames > 0 ? static_cast<double>(found) / frames : kNothing;
}

double fitness(const Trace& trace, const Window& window) {
  double sum = 0;
  int count = 0;
  each_frame(trace, window, [&](const TraceRow& row) {
    if (!row.heard.found) return;
    sum += row.heard.fitness;
    ++count;
  });
  return count > 0 ? sum / count : kNothing;
}

double throttle(const Trace& trace, const Window& window) {
  return largest(trace, window, [](const TraceRow& row) {
    double most = 0;
    for (const double t : row.throttle) most = std::max(most, std::abs(t));
    return most;
  });
}

double in_view(const Trace& trace, const Window& window) {
  int rows = 0, seen = 0;
  for (const TraceRow& row : trace.rows) {
    if (!inside(row, window)) continue;
    ++rows;
    seen += row.in_view;
  }
  return rows > 0 ? static_cast<double>(seen) / rows : kNothing;
}

double releases(const Trace& trace, const Window& window) {
  int count = 0;
  bool before = false;
  for (const TraceRow& row : trace.rows) {
    count += row.release && !before && inside(row, window);
    before = row.release;
  }
  return count;
}

template <int kAxis>
double mean_axis_mm(const Trace& trace, const Window& window) {
  return mean_place_mm(trace, window, kAxis);
}

template <int kAxis>
double abs_axis_mm(const Trace& trace, const Window& window) {
  return mean_absolute_error_mm(trace, window, kAxis);
}

template <int kAxis>
double visit_axis_mm(const Trace& trace, const Window& window) {
  return visit_absolute_error_mm(trace, window, kAxis);
}

double least_z_mm(const Trace& trace, const Window& window) {
  return distance_reach_mm(trace, window).least_mm;
}

double most_z_mm(const Trace& trace, const Window& window) {
  return distance_reach_mm(trace, window).most_mm;
}

// At the frequencies of P001's path.
template <int kAxis>
double lag_axis_deg(const Trace& trace, const Window& window) {
  return lag_deg(trace, window, kAxis, kAxis == 2 ? 1.0 / 60 : 0.05);
}

template <int kAxis>
double cutoff_axis_hz(const Trace& trace, const Window& window) {
  return cutoff_hz(bode(trace, window, kAxis));
}

template <int kAxis>
double quarter_axis_hz(const Trace& trace, const Window& window) {
  return quarter_hz(bode(trace, window, kAxis));
}

std::string state_at(const Trace& trace, double time_s) {
  std::string state = "nothing heard";
  for (const TraceRow& row : trace.rows)
    if (row.time_s <= time_s && !row.heard.supervisor.empty()) state = row.heard.supervisor;
  return state;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return std::isnan(value) ? "never" : text;
}

const Measure* find_measure(const std::string& name) {
  for (const Measure& measure : measures())
    if (name == measure.name) return &measure;
  return nullptr;
}

Error not_understood(std::string_view text, const std::string& why) {
  return Error{"check '" + std::string(text) + "': " + why};
}

bool is_comparison(const std::string& word) {
  return word.size() == 1 && std::string("<>=").find(word) != std::string::npos;
}

// "after 3 s", "until 8 s", "at 5 s" …
bool read_window(const std::vector<std::string>& words, std::size_t at, Window& window) {
  while (at + 2 < words.size() && words[at + 2] == "s") {
    const auto seconds = number_from_text(words[at + 1]);
    if (!seconds) return false;
    if (words[at] == "after")
      window.from_s = *seconds;
    else if (words[at] == "until")
      window.until_s = *seconds;
    else
      return false;
    at += 3;
  }
  return at == words.size();
}

// "within 20 ms of press estop", from words[at]. False: not of that form.
bool read_within(const std::vector<std::string>& words, std::size_t at, Check& check) {
  const auto limit = words.size() > at + 4 ? number_from_text(words[at + 1]) : std::nullopt;
  if (!limit || words[at] != "within" || words[at + 2] != "ms" || words[at + 3] != "of")
    return false;
  check.limit = *limit;
  for (std::size_t i = at + 4; i < words.size(); ++i)
    check.event += (check.event.empty() ? "" : " ") + words[i];
  return true;
}

Result<Check> parse_permit(const std::vector<std::string>& words, std::string_view text,
                           Check check) {
  check.kind = Check::Kind::kPermitNone;
  if (words.size() < 2 || words[1] != "none" || !read_within(words, 2, check))
    return not_understood(text, "the form is 'permit none within 20 ms of press estop'");
  return check;
}

Result<Check> parse_state(const std::vector<std::string>& words, std::string_view text,
                          Check check) {
  check.word = words.size() > 2 ? words[words[1] == "is" ? 2 : 1] : "";
  if (read_within(words, 2, check)) {
    check.kind = Check::Kind::kStateWithin;
    return check;
  }
  const auto time = words.size() == 6 ? number_from_text(words[4]) : std::nullopt;
  if (!time || words[1] != "is" || words[3] != "at" || words[5] != "s")
    return not_understood(text,
                          "the forms are 'state is stopped at 5 s' and 'state stopped within "
                          "20 ms of press estop'");
  check.kind = Check::Kind::kState;
  check.window.from_s = *time;
  return check;
}

Result<Check> parse_counted(const std::vector<std::string>& words, std::string_view text,
                            Check check) {
  const auto limit = words.size() == 4 ? number_from_text(words[3]) : std::nullopt;
  if (!limit || !is_comparison(words[2]))
    return not_understood(text, "the form is 'counted camera_broken > 5'");
  check.kind = Check::Kind::kCounted;
  check.word = words[1];
  check.comparison = words[2][0];
  check.limit = *limit;
  return check;
}

Result<Check> parse_measure(const std::vector<std::string>& words, std::string_view text,
                            Check check) {
  check.measure = find_measure(words[0]);
  if (check.measure == nullptr) {
    std::string names;
    for (const Measure& measure : measures()) names += std::string(" ") + measure.name;
    return not_understood(text, "'" + words[0] + "' is no measure; there are:" + names);
  }
  const auto limit = words.size() > 2 ? number_from_text(words[2]) : std::nullopt;
  if (!limit || !is_comparison(words[1]) || !read_window(words, 3, check.window))
    return not_understood(text, "the form is 'rms_x_mm < 10 after 10 s until 20 s'");
  check.comparison = words[1][0];
  check.limit = *limit;
  return check;
}

bool holds(const Check& check, double value) {
  return check.comparison == '<'   ? value < check.limit
         : check.comparison == '>' ? value > check.limit
                                   : value == check.limit;
}

Verdict judge_time(const Check& check, double ms) {
  return {check.text, std::isnan(ms) ? "never" : number(ms) + " ms", ms <= check.limit};
}

}  // namespace

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all = {
      {"settle_s", "time from arming until it stays within 20 mm and 3 degrees", settle_s},
      {"rms_x_mm", "the truth's distance from the goal along x of the hand", rms_axis_mm<0>},
      {"rms_y_mm", "the same along y", rms_axis_mm<1>},
      {"rms_z_mm", "the same along z", rms_axis_mm<2>},
      {"rms_mm", "the same in space", rms_mm},
      {"worst_z_mm", "the truth's largest distance from the goal along z of the hand", worst_z_mm},
      {"forward_mm_s", "the vehicle's highest speed ahead", forward_mm_s},
      {"backward_mm_s", "the same backwards", backward_mm_s},
      {"rms_yaw_deg", "the truth's turn away from the goal", rms_yaw_deg},
      {"worst_mm", "the largest distance from the goal", worst_mm},
      {"estimate_x_mm", "estimate minus truth along x of the left camera, rms of the found",
       estimate_axis_mm<0>},
      {"estimate_y_mm", "the same along y", estimate_axis_mm<1>},
      {"estimate_z_mm", "the same along z", estimate_axis_mm<2>},
      {"estimate_deg", "angle between estimated and true attitude, rms of the found", estimate_deg},
      {"found_share", "share of the frames in which the target was found", found_share},
      {"fitness", "mean of the found", fitness},
      {"throttle", "largest throttle that any drive obeyed, 0 to 1", throttle},
      {"in_view", "share of the time with the whole target in both images", in_view},
      {"releases", "how often the release line fired", releases},
      {"mean_x_mm", "the truth's mean place along x of the hand", mean_axis_mm<0>},
      {"mean_y_mm", "the same along y", mean_axis_mm<1>},
      {"mean_z_mm", "the same along z", mean_axis_mm<2>},
      {"least_z_mm", "the truth's least distance along z of the hand", least_z_mm},
      {"most_z_mm", "the largest", most_z_mm},
      {"abs_x_mm", "the truth's mean absolute distance from the goal along x", abs_axis_mm<0>},
      {"abs_y_mm", "the same along y", abs_axis_mm<1>},
      {"abs_z_mm", "the same along z", abs_axis_mm<2>},
      {"visit_x_mm", "abs_x_mm from a mission's arrival at a visit to its end", visit_axis_mm<0>},
      {"visit_y_mm", "the same along y", visit_axis_mm<1>},
      {"visit_z_mm", "the same along z", visit_axis_mm<2>},
      {"visits", "how many of a mission's visits were done",
       [](const Trace& trace, const Window& window) {
         return static_cast<double>(visits_done(trace, window));
       }},
      {"fitness_kept", "least fitness of the found by the median of the first 30", fitness_kept},
      {"lag_x_deg", "how far it lags behind the target at 0.05 Hz along x", lag_axis_deg<0>},
      {"lag_y_deg", "the same along y", lag_axis_deg<1>},
      {"lag_z_deg", "the same along z, at 1/60 Hz", lag_axis_deg<2>},
      {"cutoff_x_hz", "where it follows by 3 dB less, for motion multisine, along x",
       cutoff_axis_hz<0>},
      {"cutoff_y_hz", "the same along y", cutoff_axis_hz<1>},
      {"cutoff_z_hz", "the same along z", cutoff_axis_hz<2>},
      {"quarter_x_hz", "where it follows by 90 degrees late, likewise", quarter_axis_hz<0>},
      {"quarter_y_hz", "the same along y", quarter_axis_hz<1>},
      {"quarter_z_hz", "the same along z", quarter_axis_hz<2>},
  };
  return all;
}

Result<Check> parse_check(std::string_view text) {
  const std::vector<std::string> words = words_of(text);
  Check check;
  for (const std::string& word : words) check.text += (check.text.empty() ? "" : " ") + word;
  if (words.empty()) return not_understood(text, "it is empty");
  auto parsed = words[0] == "permit"    ? parse_permit(words, text, check)
                : words[0] == "state"   ? parse_state(words, text, check)
                : words[0] == "counted" ? parse_counted(words, text, check)
                                        : parse_measure(words, text, check);
  if (!parsed || parsed->event.empty()) return parsed;
  const auto action =
      is_noticed(parsed->event) ? Result<Action>(Action{}) : parse_action(parsed->event);
  if (!action) return not_understood(text, action.error().text);
  return parsed;
}

Verdict judge(const Check& check, const Trace& trace) {
  switch (check.kind) {
    case Check::Kind::kState: {
      const std::string state = state_at(trace, check.window.from_s);
      return {check.text, state, state == check.word};
    }
    case Check::Kind::kPermitNone:
      return judge_time(check, stop_ms(trace, check.event));
    case Check::Kind::kStateWithin:
      return judge_time(check, state_ms(trace, check.event, check.word));
    case Check::Kind::kCounted: {
      const auto counter = trace.counters.find(check.word);
      if (counter == trace.counters.end()) return {check.text, "not counted", false};
      return {check.text, number(counter->second), holds(check, counter->second)};
    }
    case Check::Kind::kMeasure:
      break;
  }
  const double value = check.measure->value(trace, check.window);
  return {check.text, number(value), holds(check, value)};
}

}  // namespace gannet::world
