#include "src/world/trace.hpp"

#include <cstdarg>
#include <cstddef>
#include <cstdio>

namespace gannet::world {
namespace {

[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  char buffer[512];
  va_list args;
  va_start(args, format);
  const int length = std::vsnprintf(buffer, sizeof buffer, format, args);
  va_end(args);
  text.append(buffer, static_cast<std::size_t>(length));
}

// Position and quaternion, w first.
template <class To, class From>
void append_pose(std::string& text, const Transform<To, From>& pose) {
  const Eigen::Quaterniond q = canonical(pose.rotation);
  append(text, ",%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.7f", pose.translation.x(), pose.translation.y(),
         pose.translation.z(), q.w(), q.x(), q.y(), q.z());
}

void append_names(std::string& text, const char* of) {
  for (const char* part : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"})
    append(text, ",%s_%s", of, part);
}

}  // namespace

double Trace::time_of(const std::string& text) const {
  for (const Mark& mark : marks)
    if (mark.text == text) return mark.time_s;
  return -1;
}

std::string trace_csv(const Trace& trace) {
  std::string text = "time_s";
  append_names(text, "vehicle");  // in the world
  append_names(text, "target");   // in Σ_H
  text += ",error_x_m,error_y_m,error_z_m,error_yaw_rad,in_view,estop,release,armed";
  for (int i = 0; i < trace.motors; ++i) append(text, ",throttle_%d", i + 1);
  text += ",supervisor,permit,frame,capture_s,track,found,fitness";
  append_names(text, "estimate");  // in the left camera, when the frame was taken
  append_names(text, "truth");     // the same of the truth
  text += "\n";
  for (const TraceRow& row : trace.rows) {
    append(text, "%.6f", row.time_s);
    append_pose(text, row.vehicle);
    append_pose(text, row.target);
    append(text, ",%.6f,%.6f,%.6f,%.6f,%d,%d,%d,%d", row.error_m.x(), row.error_m.y(),
           row.error_m.z(), row.error_rad, row.in_view, row.estop, row.release, row.armed);
    for (int i = 0; i < trace.motors; ++i)
      append(text, ",%.4f", row.throttle[static_cast<std::size_t>(i)]);
    append(text, ",%s,%s,%llu,%.6f,%s,%d,%.5f", row.heard.supervisor.c_str(),
           row.heard.permit.c_str(), static_cast<unsigned long long>(row.heard.frame),
           row.heard.capture_s, row.heard.state.c_str(), row.heard.found, row.heard.fitness);
    append_pose(text, row.heard.left_from_target);
    append_pose(text, row.at_capture);
    text += "\n";
  }
  return text;
}

std::string events_csv(const Trace& trace) {
  std::string text = "time_s,event\n";
  for (const Mark& mark : trace.marks) append(text, "%.6f,%s\n", mark.time_s, mark.text.c_str());
  return text;
}

}  // namespace gannet::world
