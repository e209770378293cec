#include "src/tool/answer.hpp"

#include <cmath>
#include <numbers>

#include "src/report/table.hpp"

namespace gannet::tool {
namespace {

using control::Json;
using Eigen::Vector3d;

// A negative zero is printed as zero.
Json list(const Eigen::Ref<const Eigen::VectorXd>& v) {
  Json array = Json::array();
  for (Eigen::Index i = 0; i < v.size(); ++i) array.push_back(v[i] == 0 ? 0.0 : v[i]);
  return array;
}

// Standard deviations of position and rotation.
Vector3d sigma(const Matrix6d& covariance, int first) {
  return covariance.diagonal().segment<3>(first).cwiseMax(0).cwiseSqrt();
}

std::string three(const Vector3d& v) {
  return report::number(v.x(), 1) + ", " + report::number(v.y(), 1) + ", " +
         report::number(v.z(), 1);
}

}  // namespace

Json json_of(const Answer& answer) {
  const track::Recognition& r = answer.recognition;
  Json json;
  json["found"] = r.found;
  const char* const pose_fields[] = {"position_m", "quaternion", "sigma_m", "sigma_rad"};
  for (const char* field : pose_fields) json[field] = nullptr;
  if (r.found) {
    const Eigen::Quaterniond q = canonical(r.left_from_target.rotation);
    json["position_m"] = list(r.left_from_target.translation);
    json["quaternion"] = list(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
    json["sigma_m"] = list(sigma(r.covariance, 0));
    json["sigma_rad"] = list(sigma(r.covariance, 3));
  }
  json["fitness"] = r.fitness;
  // A rectangle's size follows from its pose, a model's is known.
  json["size_m"] = nullptr;
  if (r.found || answer.model) json["size_m"] = list(r.size_m);
  json["evaluations"] = r.evaluations;
  json["time_ms"] = answer.time_ms;
  json["model"] = nullptr;
  if (answer.model) json["model"] = *answer.model;
  return json;
}

Json json_of_error(const std::string& text) { return {{"found", false}, {"error", text}}; }

std::string text_of(const Answer& answer) {
  const track::Recognition& r = answer.recognition;
  const std::string effort = "fitness " + report::number(r.fitness, 3) + ", " +
                             report::number(r.evaluations, 0) + " evaluations, " +
                             report::number(answer.time_ms, 1) + " ms\n";
  if (!r.found) return std::string("not found (") + to_string(r.reason) + "); best " + effort;
  constexpr double kDegrees = 180 / std::numbers::pi;
  return "position  " + three(1000 * r.left_from_target.translation) + " mm  (±" +
         three(1000 * sigma(r.covariance, 0)) + ")\nroll, pitch, yaw  " +
         three(kDegrees * rpy_from_quaternion(r.left_from_target.rotation)) + " deg  (±" +
         three(kDegrees * sigma(r.covariance, 3)) + ")\nsize  " +
         report::number(1000 * r.size_m.x(), 1) + " x " + report::number(1000 * r.size_m.y(), 1) +
         " mm\n" + effort;
}

}  // namespace gannet::tool
