#include "src/tool/views.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

#include "src/report/table.hpp"

namespace gannet::tool {
namespace {

using control::Json;
using report::number;

const Json& member(const Json& json, const char* key) {
  static const Json kNothing;
  const auto found = json.is_object() ? json.find(key) : json.end();
  return found == json.end() ? kNothing : *found;
}

double number_of(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string word(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  return json.is_null() ? "–" : json.dump();
}

std::string numbers(const Json& list, int decimals) {
  std::string text;
  if (!list.is_array()) return "–";
  for (const Json& value : list)
    text += (text.empty() ? "" : ", ") + number(number_of(value), decimals);
  return text;
}

std::string row(const std::string& name, const std::string& text) {
  return name + std::string(name.size() < 10 ? 10 - name.size() : 1, ' ') + text + "\n";
}

std::string estimate_rows(const Json& status) {
  const Json& estimate = member(status, "estimate");
  std::string track = word(member(estimate, "state"));
  const std::string reason = word(member(estimate, "reason"));
  if (reason != "none") track += " (" + reason + ")";
  track += ", fitness " + number(number_of(member(estimate, "fitness")), 3) + ", age " +
           number(1000 * number_of(member(estimate, "age_s")), 0) + " ms";
  std::string text = row("track", track);
  const Json& target = member(status, "target");
  if (member(target, "valid") != true) return text;
  text +=
      row("position", numbers(member(target, "position_hand_mm"), 1) + " mm in the hand frame (±" +
                          numbers(member(target, "sigma_hand_mm"), 1) + ")");
  text += row("turned", numbers(member(target, "rpy_hand_deg"), 1) + " deg");
  return text + row("error", numbers(member(target, "error_mm"), 1) + " mm, " +
                                 numbers(member(target, "error_deg"), 1) + " deg");
}

std::string chosen_text(const Json& chosen) {
  const std::string kind = word(member(chosen, "kind"));
  if (kind == "model") {
    const Json& alike = member(chosen, "alike_deg");
    const std::string text = "model " + word(member(chosen, "model"));
    if (alike == "any") return text + ", alike at any roll";
    if (!alike.is_array() || alike.empty()) return text;
    return text + ", alike when rolled by " + numbers(alike, 0) + " deg";
  }
  if (kind == "roi") return "rectangle " + numbers(member(chosen, "roi"), 0);
  return kind;
}

report::Table stage_table(const Json& loop) {
  report::Table table(
      {word(member(loop, "name")), "last µs", "mean", "max", "p99", "budget", "over"});
  const Json& stages = member(loop, "stages");
  for (std::size_t i = 0; stages.is_array() && i < stages.size(); ++i) {
    const Json& s = stages[i];
    table.add({word(member(s, "name")), number(number_of(member(s, "last_us")), 1),
               number(number_of(member(s, "mean_us")), 1),
               number(number_of(member(s, "max_us")), 1), number(number_of(member(s, "p99_us")), 1),
               number(number_of(member(s, "budget_us")), 0), word(member(s, "over_budget"))});
  }
  return table;
}

std::string latency_text(const Json& latencies) {
  report::Table table({"latency ms", "p50", "p90", "p99", "p99.9", "max"});
  if (latencies.is_object()) {
    for (const auto& [name, histogram] : latencies.items()) {
      std::vector<std::string> cells = {name};
      for (const char* key : {"p50_us", "p90_us", "p99_us", "p99_9_us", "max_us"})
        cells.push_back(number(number_of(member(histogram, key)) / 1000, 2));
      table.add(cells);
    }
  }
  return table.text();
}

std::string pairs(const Json& object, int decimals) {
  std::string text;
  if (!object.is_object()) return "–";
  for (const auto& [name, value] : object.items())
    text += (text.empty() ? "" : ", ") + name + " " + number(number_of(value), decimals);
  return text;
}

// What was wrong with images, and how far apart a pair's time stamps are: only what is not 0.
std::string camera_text(const Json& cameras) {
  Json seen = Json::object();
  if (cameras.is_object())
    for (const auto& [name, value] : cameras.items())
      if (value != 0) seen[name] = value;
  return seen.empty() ? "no faults" : pairs(seen, 1);
}

}  // namespace

std::string state_text(const Json& answer) {
  std::string text = word(member(answer, "state"));
  const std::string cause = word(member(answer, "cause"));
  if (cause != "none" && cause != "–") text += " (" + cause + ")";
  text += ", permit " + word(member(answer, "permit"));
  if (member(answer, "by_hand") == true) text += ", by hand";
  return text;
}

std::string drives_text(const Json& drives) {
  std::string text = member(drives, "all_alive") == true ? "all alive" : "not all alive";
  if (member(drives, "any_fault") == true) text += ", one in fault";
  if (member(drives, "all_ready") == false) text += ", not all set up";
  if (member(drives, "guards_itself") == false) text += ", one would not stop by itself";
  const Json& trouble = member(drives, "trouble");
  const Json& code = member(drives, "trouble_code");
  if (trouble.is_string() && trouble != "" && code.is_number_unsigned()) {
    char number[24];
    std::snprintf(number, sizeof number, " (0x%X)", code.get<unsigned>());
    const Json& index = member(drives, "first_bad");
    const std::string motor =
        index.is_number_integer() ? std::to_string(index.get<int>() + 1) : word(index);
    text += ", motor " + motor + ": " + trouble.get<std::string>() + number;
  }
  return text + ", bus " + word(member(drives, "bus"));
}

std::string status_text(const Json& status) {
  std::string text = row("state", state_text(status));
  const std::string obstacle = word(member(status, "obstacle"));
  text += row("arming", obstacle == "none" ? "possible" : "not now: " + obstacle);
  text += row("e-stop", word(member(status, "estop")));
  text += row("target", chosen_text(member(status, "chosen")));
  text += row("goal", numbers(member(status, "goal_mm"), 0) + " mm in the hand frame");
  const Json& mission = member(status, "mission");
  if (mission.is_object() && member(mission, "visits") != 0)
    text += row("mission", mission_text(mission));
  text += estimate_rows(status);
  const Json& drives = member(status, "drives");
  if (drives.is_object()) text += row("drives", drives_text(drives));
  return text + row("daemon", "gannetd " + word(member(status, "version")) + ", vehicle " +
                                  word(member(status, "vehicle")) + ", camera " +
                                  word(member(status, "camera")) + ", clock " +
                                  word(member(status, "clock")));
}

std::string visits_text(const Json& list) {
  report::Table table({"visit", "model", "goal mm", "tolerance mm", "hold s", "time-out s"});
  const Json& visits = member(list, "visits");
  for (std::size_t i = 0; visits.is_array() && i < visits.size(); ++i) {
    const Json& v = visits[i];
    table.add({std::to_string(i + 1), word(member(v, "model")), numbers(member(v, "goal_mm"), 0),
               number(number_of(member(v, "tolerance_mm")), 1),
               number(number_of(member(v, "hold_s")), 1),
               number(number_of(member(v, "time_out_s")), 1)});
  }
  return table.text() + "rounds    " + word(member(list, "rounds")) + "\n";
}

std::string mission_text(const Json& mission) {
  const std::string state = word(member(mission, "state"));
  if (state == "idle") return "idle, " + word(member(mission, "visits")) + " visits";
  const std::string where = member(mission, "there") == true ? ", there" : "";
  return state + ", visit " + word(member(mission, "visit")) + " of " +
         word(member(mission, "visits")) + ": " + word(member(mission, "model")) + where;
}

std::string top_text(const Json& top) {
  std::string text = state_text(top) + ", track " + word(member(top, "track")) + ", fitness " +
                     number(number_of(member(top, "fitness")), 3) + "\n";
  const Json& loops = member(top, "loops");
  for (std::size_t i = 0; loops.is_array() && i < loops.size(); ++i)
    text += "\n" + stage_table(loops[i]).text();
  text += "\n" + latency_text(member(top, "latencies"));
  text += "\nages ms  " + pairs(member(top, "ages_ms"), 1);
  text += "\ncameras  " + camera_text(member(top, "cameras"));
  return text + "\ncounts   " + pairs(member(top, "drops"), 0) + "\n";
}

std::string event_text(const Json& event) {
  return number(number_of(member(event, "time_ns")) / 1e9, 3) + "  " +
         word(member(event, "severity")) + "  " + word(member(event, "text"));
}

}  // namespace gannet::tool
