#include "src/world/operator.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <thread>

namespace gannet::world {
namespace {

using control::Json;

struct Method {
  std::string name;
  Json params = Json::object();
};

Method method_of(const Action& action) {
  switch (action.verb) {
    case Verb::kArm:
      return {"arm"};
    case Verb::kDisarm:
      return {"disarm"};
    case Verb::kReset:
      return {"reset"};
    case Verb::kStop:
      return {"stop"};
    case Verb::kManual: {
      Json velocity = Json::array();
      for (const double mm_s : action.numbers) velocity.push_back(mm_s / 1000);
      return {"manual", {{"linear_m_s", velocity}, {"angular_rad_s", {0.0, 0.0, 0.0}}}};
    }
    case Verb::kGoal:
      return {"goal", {{"mm", action.numbers}}};
    case Verb::kMission:
      return {"mission", {{"do", action.name}}};
    case Verb::kTarget:
      if (action.name == "none") return {"target", {{"none", true}}};
      return {"target", {{"model", action.name}}};
    default:
      return {};
  }
}

std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

double number_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0;
}

bool read_pose(const Json& estimate, Transform<LeftCamera, Target>& pose) {
  const auto p = estimate.find("position_m");
  const auto q = estimate.find("quaternion");
  if (p == estimate.end() || q == estimate.end() || p->size() != 3 || q->size() != 4) return false;
  for (const auto& value : *p)
    if (!value.is_number()) return false;
  for (const auto& value : *q)
    if (!value.is_number()) return false;
  pose.translation = {(*p)[0].get<double>(), (*p)[1].get<double>(), (*p)[2].get<double>()};
  pose.rotation = {(*q)[0].get<double>(), (*q)[1].get<double>(), (*q)[2].get<double>(),
                   (*q)[3].get<double>()};
  return true;
}

void read_mission(const Json& status, HeardEstimate& heard) {
  const auto mission = status.find("mission");
  if (mission == status.end() || !mission->is_object()) return;
  const std::string state = text_at(*mission, "state");
  const bool is_done = state == "done";
  const double visits = number_at(*mission, is_done ? "visits" : "visit");
  heard.visits_done = std::max(0, static_cast<int>(visits) - (is_done ? 0 : 1));
  const auto goal = status.find("goal_mm");
  if ((state != "running" && state != "paused") || goal == status.end() || goal->size() != 3)
    return;
  heard.visit_model = text_at(*mission, "model");
  for (int i = 0; i < 3; ++i)
    heard.visit_goal_m[i] = (*goal)[static_cast<std::size_t>(i)].get<double>() / 1000;
  const auto arrived = mission->find("arrived");
  heard.arrived = arrived != mission->end() && *arrived == true;
}

}  // namespace

HeardEstimate heard_from(const Json& status, TimePoint start) {
  HeardEstimate heard;
  heard.supervisor = text_at(status, "state");
  heard.permit = text_at(status, "permit");
  read_mission(status, heard);
  const auto estimate = status.find("estimate");
  if (estimate == status.end() || !estimate->is_object()) return heard;
  heard.frame = static_cast<std::uint64_t>(number_at(*estimate, "frame_number"));
  const auto capture = estimate->find("capture_time_ns");
  if (capture != estimate->end() && capture->is_number_integer())
    heard.capture_s = to_seconds(time_from_ns(capture->get<std::int64_t>()) - start);
  heard.state = text_at(*estimate, "state");
  heard.fitness = number_at(*estimate, "fitness");
  const auto found = estimate->find("found");
  heard.found = found != estimate->end() && found->is_boolean() && found->get<bool>() &&
                read_pose(*estimate, heard.left_from_target);
  return heard;
}

Result<Operator> Operator::connect(const std::string& socket, Duration timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (true) {
    auto client = control::Client::connect(socket);
    if (client) return Operator(std::move(*client));
    if (std::chrono::steady_clock::now() >= end) return client.error();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

Result<void> Operator::command(const Action& action) {
  const Method method = method_of(action);
  auto answer = client_.call(method.name, method.params);
  if (!answer) return Error{"'" + action.text + "': " + answer.error().text};
  return {};
}

Result<HeardEstimate> Operator::look(TimePoint start, Duration timeout) {
  auto answer = client_.call("status", Json::object(), timeout);
  if (!answer) return answer.error();
  return heard_from(*answer, start);
}

Result<Json> Operator::top() { return client_.call("top"); }

}  // namespace gannet::world
