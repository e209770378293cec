// VisionLoop: 1 takes a new choice of target  2 takes the newest pair, gives older ones back
// 3 recognises  4 publishes the estimate  5 hands the pair on to the archive, or home.
// Knows no thread: the same body runs live and stepped. Vision thread; RT safe.
#pragma once

#include "platform/base/event.hpp"
#include "platform/base/parallel.hpp"
#include "src/daemon/frame_line.hpp"
#include "src/daemon/messages.hpp"
#include "src/track/target_tracker.hpp"

namespace gannet::daemon {

class VisionLoop {
 public:
  struct Links {
    track::TargetTracker* tracker;
    Parallel* parallel;
    FrameLine* from_capture;
    FrameLine* to_archive;  // null: nobody records
    SpscRing<TargetChoice>* choices;
    SpscRing<SeenTarget>* to_servo;
    LatestValue<VisionReport>* report;
    EventPort* events;
    SharedFacts* facts;
  };

  // preempt: a newer pair ends the search (live); without it the search ends by evaluations alone.
  // silence: without a pair for longer the track ages.
  VisionLoop(const Links& links, bool preempt, Duration silence);

  bool step(TimePoint now);  // true: a pair was looked at

 private:
  enum Stage { kChoose, kTakeNewest, kRecognise, kPublish, kHandOn };
  void choose(TimePoint now);
  bool take_newest(TakenFrame& newest);
  PoseEstimate recognise(const hal::StereoFrame& frame);
  void publish(const PoseEstimate& estimate, TimePoint taken, TimePoint now);
  void hand_on(TakenFrame&& frame);
  void look_at(TakenFrame&& frame, TimePoint now);

  Links links_;
  const bool preempt_;
  const Duration silence_;
  TimePoint last_pair_ = {};
  bool any_pair_ = false;
  VisionReport report_;
};

}  // namespace gannet::daemon
