#include "src/tool/online.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <thread>

#include "src/control/client.hpp"
#include "src/report/progress.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/views.hpp"

namespace gannet::tool {
namespace {

using control::Client;
using control::Json;
using Texts = std::function<std::string(const Json&)>;

const char* const kExitCodes =
    "0  done\n1  the daemon refuses, its reason is printed\n2  bad input, or nobody serves the "
    "socket";

Command describe(const std::string& words, const std::string& summary, const std::string& example) {
  return {.name = "gannet " + words,
          .summary = summary,
          .options = {{.name = "socket",
                       .value = "PATH",
                       .preset = "/run/gannet/control",
                       .help = "The daemon's control socket."},
                      {.name = "json",
                       .kind = ArgumentKind::kFlag,
                       .help = "Print the daemon's answer as JSON."}},
          .example = example,
          .exit_codes = kExitCodes,
          .see_also = "gannet(1), gannetd(8)"};
}

// One program's talk with the daemon.
class Talk {
 public:
  Talk(const char* name, const Arguments& arguments)
      : name_(name), json_(arguments.flag("json")), path_(arguments.text("socket")) {}

  // 0 and the answer, or the exit code, with the reason told.
  int ask(const std::string& method, const Json& params, Json& answer) {
    if (!client_) {
      auto client = Client::connect(path_);
      if (!client) return refuse(2, client.error().text, {{"code", "unreachable"}});
      client_ = std::make_unique<Client>(std::move(*client));
    }
    auto result = client_->call(method, params);
    if (!result) {
      const Json& failure = client_->last_failure();
      const auto code = failure.is_object() ? failure.find("code") : failure.end();
      const bool refused = code != failure.end() && (*code == "refused" || *code == "busy");
      return refuse(refused ? 1 : 2, result.error().text, failure);
    }
    answer = std::move(*result);
    return 0;
  }

  int refuse(int exit_code, const std::string& text, const Json& failure) {
    if (json_) {
      Json error = failure.is_object() ? failure : Json::object();
      if (!error.contains("text")) error["text"] = text;
      std::printf("%s\n", Json{{"error", error}}.dump().c_str());
    }
    tell(name_, text);
    return exit_code;
  }

  // The whole of a simple command.
  int ask_and_print(const std::string& method, const Json& params, const Texts& text) {
    Json answer;
    if (const int code = ask(method, params, answer)) return code;
    print(answer, text);
    return 0;
  }

  void print(const Json& answer, const Texts& text) const {
    std::printf("%s\n", json_ ? answer.dump().c_str() : text(answer).c_str());
    std::fflush(stdout);
  }

  bool json() const { return json_; }

 private:
  const char* name_;
  const bool json_;
  const std::string path_;
  std::unique_ptr<Client> client_;
};

// Whoever asked for JSON gets some, also where the words were wrong already.
void tell_bad_arguments(std::span<const std::string> args, const std::string& text) {
  if (std::find(args.begin(), args.end(), "--json") == args.end()) return;
  const Json error = {{"code", "bad_params"}, {"text", text}};
  std::printf("%s\n", Json{{"error", error}}.dump().c_str());
}

std::string without_last_newline(std::string text) {
  if (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

int run_status(const Arguments& arguments) {
  return Talk("gannet status", arguments)
      .ask_and_print("status", Json::object(),
                     [](const Json& j) { return without_last_newline(status_text(j)); });
}

int run_arm(const Arguments& arguments) {
  return Talk("gannet arm", arguments).ask_and_print("arm", Json::object(), state_text);
}
int run_disarm(const Arguments& arguments) {
  return Talk("gannet disarm", arguments).ask_and_print("disarm", Json::object(), state_text);
}
int run_reset(const Arguments& arguments) {
  return Talk("gannet reset", arguments).ask_and_print("reset", Json::object(), state_text);
}
int run_stop(const Arguments& arguments) {
  return Talk("gannet stop", arguments).ask_and_print("stop", Json::object(), state_text);
}

Command describe_target() {
  Command command = describe("target", "chooses what the daemon looks for",
                             "gannet target model crab\ngannet target roi 250,180,96,80\n"
                             "gannet target none");
  command.positionals = {
      {.name = "kind",
       .choices = {"model", "roi", "none"},
       .required = true,
       .help = "A model of the daemon's list, a rectangle of the left image, or "
               "nothing."},
      {.name = "value", .help = "The model's name; X,Y,W,H in whole pixels; nothing for none."}};
  return command;
}

Result<Json> target_params(const std::string& kind, const std::string& value) {
  if (kind == "none")
    return value.empty() ? Result<Json>(Json{{"none", true}}) : Error{"none takes no value"};
  if (value.empty()) return Error{kind == "model" ? "model needs a name" : "roi needs X,Y,W,H"};
  if (kind == "model") return Json{{"model", value}};
  Json roi = Json::array();
  for (std::size_t at = 0; at <= value.size();) {
    const std::size_t end = std::min(value.find(',', at), value.size());
    const auto number = integer_from_text(value.substr(at, end - at));
    if (!number) return Error{"'" + value + "' is not of the form X,Y,W,H in whole pixels"};
    roi.push_back(*number);
    at = end + 1;
  }
  if (roi.size() != 4) return Error{"'" + value + "' is not of the form X,Y,W,H in whole pixels"};
  return Json{{"roi", roi}};
}

int run_target(const Arguments& arguments) {
  Talk talk("gannet target", arguments);
  const auto params = target_params(arguments.text("kind"), arguments.text("value"));
  if (!params) return talk.refuse(2, params.error().text, {{"code", "bad_params"}});
  return talk.ask_and_print("target", *params, [](const Json& j) { return j.dump(); });
}

Command describe_goal() {
  Command command =
      describe("goal", "sets where the target shall be, seen from the hand", "gannet goal 0,0,500");
  command.positionals = {{.name = "X,Y,Z",
                          .kind = ArgumentKind::kNumbers,
                          .value = "X,Y,Z",
                          .count = 3,
                          .min = -100000,
                          .max = 100000,
                          .unit = "mm",
                          .required = true,
                          .help = "Position of the target in the hand frame: x right, y down, z "
                                  "ahead."}};
  return command;
}

int run_goal(const Arguments& arguments) {
  return Talk("gannet goal", arguments)
      .ask_and_print("goal", Json{{"mm", arguments.numbers("X,Y,Z")}},
                     [](const Json& j) { return j.dump(); });
}

int run_config_show(const Arguments& arguments) {
  return Talk("gannet config show", arguments)
      .ask_and_print("config_show", Json::object(), [](const Json& j) {
        return without_last_newline(j.value("text", std::string()));
      });
}

Command describe_events() {
  Command command =
      describe("events", "prints what happened in the daemon", "gannet events --follow");
  command.options.push_back({.name = "follow",
                             .kind = ArgumentKind::kFlag,
                             .help = "Go on printing what happens, until interrupted."});
  command.options.push_back({.name = "since",
                             .kind = ArgumentKind::kInteger,
                             .value = "NUMBER",
                             .min = 0,
                             .preset = "0",
                             .help = "Only events after this number."});
  return command;
}

void print_events(const Talk& talk, const Json& answer) {
  const auto events = answer.find("events");
  if (events == answer.end() || !events->is_array()) return;
  for (const Json& event : *events) talk.print(event, event_text);
}

int run_events(const Arguments& arguments) {
  Talk talk("gannet events", arguments);
  Json since = arguments.integer("since");
  while (true) {
    Json answer;
    if (const int code = talk.ask("events", {{"since", since.get<std::uint64_t>()}}, answer))
      return code;
    print_events(talk, answer);
    if (!arguments.flag("follow")) return 0;
    if (answer.contains("last") && answer["last"].is_number_unsigned()) since = answer["last"];
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

Command describe_top() {
  Command command = describe("top", "shows the loops' times, drops and ages", "gannet top");
  command.description =
      "On a terminal the picture is renewed twice a second until interrupted; elsewhere, and with "
      "--once or --json, it is printed once.";
  command.options.push_back(
      {.name = "once", .kind = ArgumentKind::kFlag, .help = "Print it once and end."});
  return command;
}

int run_top(const Arguments& arguments) {
  Talk talk("gannet top", arguments);
  const bool live = !arguments.flag("once") && !talk.json() && report::is_terminal(STDOUT_FILENO);
  do {
    Json answer;
    if (const int code = talk.ask("top", Json::object(), answer)) return code;
    if (live) std::printf("\033[H\033[2J");
    talk.print(answer, [](const Json& j) { return without_last_newline(top_text(j)); });
    if (live) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  } while (live);
  return 0;
}

Command describe_mission() {
  Command command = describe("mission", "visits the config's targets in turn",
                             "gannet mission list\ngannet mission start");
  command.description =
      "Visits are [[mission.visit]] in gannet.toml(5). A mission starts only in an armed vehicle, "
      "and never arms one. It pauses while its target is lost. A visit that takes too long is "
      "given "
      "up: nothing is followed until start, which then goes on with that visit. stop, disarm, a "
      "fault, and a target or goal of somebody else end it.";
  command.positionals = {{.name = "do",
                          .choices = {"list", "start", "stop", "status"},
                          .required = true,
                          .help = "Show the visits, start or end them, or say how far it is."}};
  return command;
}

int run_mission(const Arguments& arguments) {
  const std::string word = arguments.text("do");
  return Talk("gannet mission", arguments)
      .ask_and_print("mission", Json{{"do", word}}, [&word](const Json& j) {
        return word == "list" ? without_last_newline(visits_text(j)) : mission_text(j);
      });
}

Command describe_manual() {
  Command command = describe("manual", "moves the vehicle by hand for a while",
                             "gannet manual 0.1,0,0 --seconds 2\ngannet manual 0,0,0 0,0,0.3");
  command.description =
      "Sends the wish ten times a second, because the daemon forgets one that is old. The vehicle "
      "must be armed.";
  const Argument velocity = {.name = "",
                             .kind = ArgumentKind::kNumbers,
                             .value = "X,Y,Z",
                             .count = 3,
                             .min = -5,
                             .max = 5};
  Argument linear = velocity;
  linear.name = "LINEAR";
  linear.unit = "m/s";
  linear.required = true;
  linear.help = "Velocity of the body: forward, left, up.";
  Argument angular = velocity;
  angular.name = "ANGULAR";
  angular.unit = "rad/s";
  angular.preset = "0,0,0";
  angular.help = "Rate of turn about the same axes.";
  command.positionals = {linear, angular};
  command.options.push_back({.name = "seconds",
                             .kind = ArgumentKind::kNumber,
                             .value = "S",
                             .min = 0.1,
                             .max = 600,
                             .unit = "s",
                             .preset = "1",
                             .help = "How long."});
  return command;
}

int run_manual(const Arguments& arguments) {
  Talk talk("gannet manual", arguments);
  const Json params = {{"linear_m_s", arguments.numbers("LINEAR")},
                       {"angular_rad_s", arguments.numbers("ANGULAR")}};
  Json answer;
  const auto end = std::chrono::steady_clock::now() + from_seconds(arguments.number("seconds"));
  do {
    if (const int code = talk.ask("manual", params, answer)) return code;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  } while (std::chrono::steady_clock::now() < end);
  talk.print(answer, state_text);
  return 0;
}

}  // namespace

std::vector<Subcommand> online_subcommands() {
  std::vector<Subcommand> all = {
      {describe("status", "tells state, target and estimate of the daemon", "gannet status"),
       &run_status},
      {describe("arm", "lets the daemon move the vehicle", "gannet arm"), &run_arm},
      {describe("disarm", "takes the permit to move back", "gannet disarm"), &run_disarm},
      {describe("reset", "leaves Stopped or Faulted, once the cause is gone", "gannet reset"),
       &run_reset},
      {describe("stop", "stops the vehicle at once; only reset leaves that state", "gannet stop"),
       &run_stop},
      {describe_target(), &run_target},
      {describe_goal(), &run_goal},
      {describe_mission(), &run_mission},
      {describe_manual(), &run_manual},
      {describe("config show", "prints each value of the configuration and where it comes from",
                "gannet config show"),
       &run_config_show},
      {describe_events(), &run_events},
      {describe_top(), &run_top},
  };
  for (Subcommand& sub : all) sub.tell_bad_arguments = &tell_bad_arguments;
  return all;
}

}  // namespace gannet::tool
