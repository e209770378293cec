#include "src/daemon/reports.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "platform/base/log.hpp"
#include "src/servo/mission.hpp"
#include "src/telemetry/event_codes.hpp"

namespace gannet::daemon {

using control::Json;

namespace {

double microseconds(Duration d) { return static_cast<double>(d.count()) * 1e-3; }
double degrees(double radians) { return radians * 180 / M_PI; }

template <class Vector>
Json array_of(const Vector& v, double scale = 1) {
  Json array = Json::array();
  for (Eigen::Index i = 0; i < v.size(); ++i) array.push_back(v(i) * scale);
  return array;
}

Json stage_json(const StageStats& s) {
  Json json;
  json["name"] = s.name;
  json["count"] = s.count;
  json["last_us"] = microseconds(s.last);
  json["mean_us"] = microseconds(s.mean());
  json["max_us"] = microseconds(s.max);
  json["p50_us"] = microseconds(s.histogram.percentile(0.5));
  json["p99_us"] = microseconds(s.histogram.percentile(0.99));
  if (s.budget.count() > 0) {
    json["budget_us"] = microseconds(s.budget);
    json["over_budget"] = s.over_budget;
  }
  return json;
}

template <int N>
Json loop_json(const char* name, const telemetry::LoopTelemetry<N>& loop) {
  Json json;
  json["name"] = name;
  json["cycles"] = loop.cycles;
  json["stages"] = Json::array();
  for (const StageStats& stage : loop.timer.stages()) json["stages"].push_back(stage_json(stage));
  return json;
}

Json histogram_json(const LogHistogram& h) {
  Json json;
  json["count"] = h.total();
  const std::pair<const char*, double> shares[] = {
      {"p50_us", 0.5}, {"p90_us", 0.9}, {"p99_us", 0.99}, {"p99_9_us", 0.999}, {"max_us", 1}};
  for (const auto& [name, share] : shares) json[name] = microseconds(h.percentile(share));
  json["buckets"] = Json::array();  // [upper edge in µs, count] of those that are not empty
  for (int i = 0; i < LogHistogram::kBuckets; ++i) {
    if (h.count(i) == 0) continue;
    json["buckets"].push_back(
        {static_cast<double>(LogHistogram::upper_edge(i)) * 1e-3, h.count(i)});
  }
  return json;
}

}  // namespace

const char* to_string(hal::BusState state) {
  constexpr std::array<const char*, 5> kNames = {"good", "warning", "passive", "off", "down"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string word_of(std::string_view kind, int value) {
  if (value < 0) return "";
  if (kind == "state" && value < safety::kStates) {
    return safety::to_string(static_cast<safety::State>(value));
  }
  if (kind == "cause" && value < safety::kCauses) {
    return safety::to_string(static_cast<safety::Cause>(value));
  }
  if (kind == "mission" && value < servo::kMissionStates) {
    return servo::to_string(static_cast<servo::MissionState>(value));
  }
  if (kind == "track") return gannet::to_string(static_cast<TrackState>(value));
  if (kind == "reason") return gannet::to_string(static_cast<TrackReason>(value));
  if (kind == "bus" && value <= static_cast<int>(hal::BusState::kDown)) {
    return to_string(static_cast<hal::BusState>(value));
  }
  if (kind == "hex") {
    char text[16];
    std::snprintf(text, sizeof text, "0x%X", static_cast<unsigned>(value));
    return text;
  }
  return "";
}

void Reports::refresh() {
  capture_ = &lines_->capture.read();
  vision_ = &lines_->vision.read();
  servo_ = &lines_->servo.read();
  drain(lines_->capture_events);
  drain(lines_->vision_events);
  drain(lines_->servo_events);
  drain(lines_->archive_events);
}

void Reports::drain(EventPort& port) {
  Event event;
  while (port.take(event)) add_event(event);
}

void Reports::add_event(const Event& event) {
  events_.add(event);
  log(event.severity, telemetry::text_of(event, word_of));
}

Json Reports::estimate_json(const std::vector<std::string>& models, TimePoint now) const {
  const PoseEstimate& e = vision_->estimate;
  Json json;
  json["target_id"] = e.target_id;
  const bool has_model = e.model >= 0 && e.model < static_cast<int>(models.size());
  json["model"] = has_model ? Json(models[static_cast<std::size_t>(e.model)]) : Json();
  json["state"] = gannet::to_string(e.state);
  json["reason"] = gannet::to_string(e.reason);
  json["found"] = e.found;
  const bool has_frame = e.frame_number > 0;
  json["frame_number"] = e.frame_number;
  json["age_s"] = has_frame ? Json(to_seconds(now - e.capture_time)) : Json();
  json["capture_time_ns"] = has_frame ? Json(to_ns(e.capture_time)) : Json();
  json["frame"] = "left camera: x right, y down, z forward";
  json["position_m"] = e.found ? array_of(e.left_from_target.translation) : Json();
  const Eigen::Quaterniond q = canonical(e.left_from_target.rotation);
  json["quaternion"] = e.found ? Json({q.w(), q.x(), q.y(), q.z()}) : Json();
  json["covariance"] = e.found ? array_of(e.covariance.reshaped<Eigen::RowMajor>()) : Json();
  json["covariance_order"] = {"x", "y", "z", "rx", "ry", "rz"};  // m², rad²; row by row
  json["size_m"] = e.found ? array_of(e.size_m) : Json();
  json["fitness"] = e.fitness;
  json["evaluations"] = e.evaluations;
  json["time_ms"] = to_seconds(e.time_spent) * 1e3;
  return json;
}

Json Reports::target_json(const StereoRig& rig) const {
  const PredictedPose& p = servo_->target;
  Json json;
  json["valid"] = p.valid;
  if (!p.valid) return json;
  const Transform<Hand, Target> hand_from_target = rig.hand_from_left * p.left_from_target;
  const Eigen::Matrix3d turn = rig.hand_from_left.rotation.toRotationMatrix();
  json["target_id"] = p.target_id;
  json["age_s"] = to_seconds(p.age);
  json["position_hand_mm"] = array_of(hand_from_target.translation, 1e3);
  json["rpy_hand_deg"] = array_of(rpy_from_quaternion(hand_from_target.rotation), degrees(1));
  json["velocity_hand_mm_s"] = array_of(Eigen::Vector3d(turn * p.relative.linear), 1e3);
  const Eigen::Matrix3d covariance = turn * p.covariance.topLeftCorner<3, 3>() * turn.transpose();
  json["sigma_hand_mm"] = array_of(Eigen::Vector3d(covariance.diagonal().cwiseSqrt()), 1e3);
  json["error_mm"] = array_of(servo_->error.position_m, 1e3);
  json["error_deg"] = array_of(servo_->error.rotation_rad, degrees(1));
  return json;
}

Json Reports::events_json(std::uint64_t since, std::size_t most) const {
  Json json;
  json["events"] = Json::array();
  std::uint64_t last = since;
  for (const auto& entry : events_.entries()) {
    if (entry.number <= since || json["events"].size() == most) continue;
    const auto* words = telemetry::words_of(entry.event.code);
    Json event;
    event["number"] = entry.number;
    event["time_ns"] = to_ns(entry.event.time);
    event["severity"] = to_string(entry.event.severity);
    event["name"] = words == nullptr ? "unknown" : words->name;
    event["text"] = telemetry::text_of(entry.event, word_of);
    event["args"] = entry.event.args;
    json["events"].push_back(event);
    last = entry.number;
  }
  json["last"] = last;
  json["lost"] = lines_->capture_events.lost() + lines_->vision_events.lost() +
                 lines_->servo_events.lost() + lines_->archive_events.lost();
  return json;
}

Json Reports::loops_json() const {
  return Json::array({loop_json("capture", capture_->loop), loop_json("vision", vision_->loop),
                      loop_json("servo", servo_->loop)});
}

Json Reports::histograms_json() const {
  Json json;
  json["frame_to_pose"] = histogram_json(vision_->frame_to_pose);
  json["frame_to_can"] = histogram_json(servo_->frame_to_can);
  json["exposure_to_can"] = histogram_json(servo_->exposure_to_can);
  json["servo_jitter"] = histogram_json(servo_->jitter);
  return json;
}

Json Reports::drops_json() const {
  Json json;
  json["frames"] = capture_->camera.frames;
  json["camera_dropped"] = capture_->camera.dropped;
  json["camera_broken"] = capture_->camera.broken;
  json["camera_lost"] = capture_->camera.lost;
  json["vision_not_taken"] = capture_->not_taken;
  json["vision_skipped"] = vision_->skipped;
  json["vision_preempted"] = vision_->preempted;
  json["estimates_lost"] = vision_->estimates_lost;
  json["estimates_rejected"] = servo_->filter_rejected;
  json["not_archived"] = vision_->not_archived;
  json["servo_overruns"] = servo_->overruns;
  json["can_sent"] = servo_->can.sent;
  json["can_send_refused"] = servo_->can.send_refused;
  json["can_send_no_room"] = servo_->can.send_no_room;
  json["can_received"] = servo_->can.received;
  json["can_receive_dropped"] = servo_->can.receive_dropped;
  json["can_malformed"] = servo_->can.malformed + servo_->drives_malformed;
  json["can_error_frames"] = servo_->can.error_frames;
  json["can_no_ack"] = servo_->can.no_ack;
  json["can_bus_off"] = servo_->can.bus_off;
  json["can_restarts"] = servo_->can.restarts;
  json["can_links_lost"] = servo_->can.links_lost;
  json["can_clock_steps"] = servo_->can.clock_steps;
  json["estop_discrepancies"] = servo_->estop_discrepancies;
  return json;
}

Json Reports::cameras_json() const {
  const hal::CaptureCounters& camera = capture_->camera;
  Json json;
  json["error_flagged"] = camera.error_flagged;
  json["short"] = camera.short_frames;
  json["frozen"] = camera.frozen;
  json["backward"] = camera.backward;
  json["off_clock"] = camera.off_clock;
  json["unpaired"] = camera.unpaired;
  json["undecoded"] = camera.undecoded;
  json["decoded_late"] = camera.decoded_late;
  json["missed"] = camera.missed;
  json["skew_ms"] = camera.skew_s * 1e3;
  json["skew_max_ms"] = camera.skew_max_s * 1e3;
  return json;
}

}  // namespace gannet::daemon
