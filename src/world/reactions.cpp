#include "src/world/reactions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "src/report/table.hpp"

namespace gannet::world {
namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

bool still_at(const Trace& trace, double time_s) {
  bool still = true;  // before anybody told them anything
  for (const TurnMark& turn : trace.turns)
    if (turn.time_s < time_s) still = turn.still;
  return still;
}

// The first time from `from_s` on at which the drives begin to be so.
double next_turn(const Trace& trace, double from_s, bool still) {
  for (const TurnMark& turn : trace.turns)
    if (turn.time_s >= from_s && turn.still == still) return turn.time_s;
  return kNever;
}

bool pressed_at(const Trace& trace, double time_s) {
  const auto row = std::find_if(trace.rows.begin(), trace.rows.end(),
                                [&](const TraceRow& r) { return r.time_s >= time_s; });
  return row != trace.rows.end() && row->estop;
}

void find_state(const Trace& trace, double from_s, double until_s, Reaction& reaction) {
  std::string before;
  for (const TraceRow& row : trace.rows) {
    if (row.time_s >= until_s) return;
    if (row.heard.supervisor.empty()) continue;
    if (row.time_s < from_s || before.empty()) {
      before = row.heard.supervisor;
    } else if (row.heard.supervisor != before) {
      reaction.state = row.heard.supervisor;
      reaction.state_ms = 1000 * (row.time_s - from_s);
      return;
    }
  }
}

std::string cell(double ms) { return std::isnan(ms) ? "-" : report::number(ms, 1); }

}  // namespace

bool is_noticed(std::string_view event) { return event == kDaemonGone || event == kDaemonBack; }

double stop_ms(const Trace& trace, const std::string& event) {
  const double start = trace.time_of(event);
  if (start < 0 || trace.turns.empty()) return kNever;
  const double still = still_at(trace, start) ? start : next_turn(trace, start, true);
  if (std::isnan(still)) return kNever;
  const double again = next_turn(trace, still, false);
  if (!std::isnan(again) && pressed_at(trace, again)) return kNever;
  return 1000 * (still - start);
}

double state_ms(const Trace& trace, const std::string& event, const std::string& state) {
  const double start = trace.time_of(event);
  if (start < 0) return kNever;
  for (const TraceRow& row : trace.rows)
    if (row.time_s >= start && row.heard.supervisor == state) return 1000 * (row.time_s - start);
  return kNever;
}

std::vector<Reaction> reactions_of(const Trace& trace) {
  std::vector<Reaction> reactions;
  for (std::size_t i = 0; i < trace.marks.size(); ++i) {
    const double from = trace.marks[i].time_s;
    const double until = i + 1 < trace.marks.size() ? trace.marks[i + 1].time_s : 1e18;
    Reaction reaction = {trace.marks[i].text, from, kNever, kNever, kNever, ""};
    const bool was_still = still_at(trace, from);
    const double changed = next_turn(trace, from, !was_still);
    if (changed < until)
      (was_still ? reaction.turning_ms : reaction.still_ms) = 1000 * (changed - from);
    find_state(trace, from, until, reaction);
    reactions.push_back(std::move(reaction));
  }
  return reactions;
}

std::string reactions_table(const Trace& trace) {
  const auto reactions = reactions_of(trace);
  if (reactions.empty()) return "";
  report::Table table({"reactions", "at, s", "drives still, ms", "turning, ms", "state", "ms"});
  for (const Reaction& r : reactions)
    table.add({r.event, report::number(r.time_s, 3), cell(r.still_ms), cell(r.turning_ms),
               r.state.empty() ? "-" : r.state, cell(r.state_ms)});
  return table.text();
}

}  // namespace gannet::world
