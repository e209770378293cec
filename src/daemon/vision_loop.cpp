#include "src/daemon/vision_loop.hpp"

#include <utility>

#include "platform/linux/clock.hpp"
#include "src/telemetry/event_codes.hpp"

#include "platform/base/rt_only.hpp"

namespace gannet::daemon {

using linux_os::monotonic_now;
using telemetry::make_event;

VisionLoop::VisionLoop(const Links& links, bool preempt, Duration silence)
    : links_(links), preempt_(preempt), silence_(silence) {
  auto& timer = report_.loop.timer;
  timer.name(kChoose, "choose");
  timer.name(kTakeNewest, "take_newest");
  timer.name(kRecognise, "recognise");
  timer.name(kPublish, "publish");
  timer.name(kHandOn, "hand_on");
}

bool VisionLoop::step(TimePoint now) {
  auto& timer = report_.loop.timer;
  TakenFrame newest;
  timer.begin(monotonic_now());
  choose(now);
  timer.lap(kChoose, monotonic_now());
  const bool got = take_newest(newest);
  if (got) {
    timer.lap(kTakeNewest, monotonic_now());
    look_at(std::move(newest), now);
  } else if (any_pair_ && now - last_pair_ > silence_) {
    publish(links_.tracker->no_frame(now), {}, now);
  }
  report_.loop.cycles += 1;
  report_.loop.time = now;
  links_.report->write(report_);
  links_.facts->vision_cycles.store(report_.loop.cycles, std::memory_order_relaxed);
  return got;
}

void VisionLoop::look_at(TakenFrame&& taken, TimePoint now) {
  auto& timer = report_.loop.timer;
  last_pair_ = now;
  any_pair_ = true;
  const TimePoint begun = monotonic_now();
  PoseEstimate estimate = recognise(taken.frame);
  estimate.time_spent = monotonic_now() - begun;
  timer.lap(kRecognise, monotonic_now());
  publish(estimate, taken.taken, now);
  const TimePoint published = monotonic_now();
  timer.lap(kPublish, published);
  report_.frame_to_pose.add(published - taken.taken);
  report_.frames += 1;
  hand_on(std::move(taken));
  timer.lap(kHandOn, monotonic_now());
}

void VisionLoop::choose(TimePoint now) {
  TargetChoice choice;
  while (links_.choices->pop(choice)) {
    bool chosen = true;
    if (choice.kind == TargetChoice::Kind::kModel) {
      chosen = links_.tracker->choose_model(choice.model, choice.id);
    } else if (choice.kind == TargetChoice::Kind::kRectangle) {
      chosen = links_.tracker->choose_rectangle(choice.rectangle, choice.id);
    } else {
      links_.tracker->choose_none();
    }
    // The control thread has checked it before; a refusal here is a bug of ours.
    links_.events->raise(chosen ? make_event(telemetry::kTargetChosen, now, choice.id)
                                : make_event(telemetry::kInternalFault, now, kChoose));
  }
}

bool VisionLoop::take_newest(TakenFrame& newest) {
  if (!links_.from_capture->pop(newest)) return false;
  while (links_.from_capture->pop(newest)) report_.skipped += 1;  // the older one goes home
  return true;
}

PoseEstimate VisionLoop::recognise(const hal::StereoFrame& frame) {
  track::Budget budget;
  struct Watch {
    const FrameLine* line;
    bool stopped = false;
  } watch{links_.from_capture};
  if (preempt_) {
    budget.context = &watch;
    budget.stop = [](void* context) {
      auto* w = static_cast<Watch*>(context);
      w->stopped = !w->line->empty();
      return w->stopped;
    };
  }
  PoseEstimate estimate = links_.tracker->process(frame.left, frame.right, frame.capture_time,
                                                  frame.number, budget, *links_.parallel);
  if (watch.stopped) report_.preempted += 1;
  return estimate;
}

void VisionLoop::publish(const PoseEstimate& estimate, TimePoint taken, TimePoint now) {
  const PoseEstimate& before = report_.estimate;
  if (estimate.state != before.state || estimate.target_id != before.target_id) {
    links_.events->raise(make_event(telemetry::kTrackChanged, now,
                                    static_cast<double>(estimate.state),
                                    static_cast<double>(estimate.reason), estimate.target_id));
  }
  report_.estimate = estimate;
  if (!links_.to_servo->push({estimate, taken})) report_.estimates_lost += 1;
}

void VisionLoop::hand_on(TakenFrame&& taken) {
  // Without an archive, or without room there, the pair goes home as `taken` ends.
  if (links_.to_archive == nullptr) return;
  if (!links_.to_archive->push(std::move(taken))) report_.not_archived += 1;
}

}  // namespace gannet::daemon
