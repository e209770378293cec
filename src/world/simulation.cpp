#include "src/world/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "platform/linux/clock.hpp"
#include "platform/linux/periodic.hpp"
#include "src/world/reactions.hpp"

namespace gannet::world {
namespace {

constexpr TimePoint kSteppedStart = time_from_ns(1'000'000'000);

// The daemon's counters by their names, from wherever in its figures they stand.
std::map<std::string, double> counters_of(const control::Json& top) {
  std::map<std::string, double> counters;
  for (const char* group : {"drops", "cameras"}) {
    const auto found = top.find(group);
    if (found == top.end() || !found->is_object()) continue;
    for (const auto& [name, value] : found->items())
      if (value.is_number()) counters[name] = value.get<double>();
  }
  return counters;
}

}  // namespace

bool RunResult::passed() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.passed; });
}

Result<std::unique_ptr<Simulation>> Simulation::create(const Scenario& scenario,
                                                       const SimulationOptions& options) {
  auto files = RunFiles::create(options.folder);
  if (!files) return files.error();
  std::unique_ptr<Simulation> simulation(new Simulation(scenario, options, std::move(*files)));
  const auto made = simulation->make_devices();
  if (!made) return made.error();
  return simulation;
}

Simulation::Simulation(const Scenario& scenario, const SimulationOptions& options, RunFiles files)
    : scenario_(scenario),
      options_(options),
      files_(std::move(files)),
      rig_(scenario.rig()),
      period_(from_seconds(1 / scenario.daemon.servo_hz)),
      plant_(make_plant(scenario.vehicle)) {
  plant_->set_pose(scenario.start_pose());
  const std::vector<double>& current = scenario.vehicle.current_mm_s;
  plant_->set_current(scenario.world_from_reference().rotation *
                      Eigen::Vector3d(current[0], current[1], current[2]) / 1000);
  trace_.period_s = to_seconds(period_);
  trace_.reference_from_world = scenario.world_from_reference().inverse();
  trace_.body_from_hand = *rig_.body_from_hand;
}

Simulation::~Simulation() = default;

TimePoint Simulation::moment(TimePoint due) const {
  return options_.stepped ? due : linux_os::monotonic_now();
}

Result<RunResult> Simulation::run(const Tick& tick) {
  const auto begin = std::chrono::steady_clock::now();
  RunResult result;
  auto person = meet_daemon();
  if (!person) return person.error();
  start_ = options_.stepped ? kSteppedStart : linux_os::monotonic_now() + period_;
  operator_ = options_.stepped ? direct_link(std::move(*person), start_)
                               : patient_link(std::move(*person), control_socket(), start_);
  const auto done = periods(tick);
  if (!done) return done.error();
  if (auto top = operator_->finish()) result.top = std::move(*top);
  end_daemon(result);
  result.trace = std::move(trace_);
  result.trace.counters = counters_of(result.top);
  std::vector<Verdict> verdicts;
  for (const Check& check : scenario_.checks) verdicts.push_back(judge(check, result.trace));
  result.verdicts.insert(result.verdicts.begin(), verdicts.begin(), verdicts.end());
  result.cameras = cameras_->counters();
  result.notes = notes_;
  result.host_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

Result<void> Simulation::periods(const Tick& tick) {
  const auto count = static_cast<long>(std::lround(scenario_.duration_s / to_seconds(period_)));
  cameras_->start(start_);
  linux_os::Periodic clock(start_, period_);
  for (long k = 0; k <= count; ++k) {
    TimePoint now = start_ + k * period_;
    if (!options_.stepped) {
      const auto wake = clock.wait();
      k += static_cast<long>(wake.missed);
      for (std::int64_t i = 0; i < wake.missed; ++i) plant_->advance(to_seconds(period_));
      now = wake.due;
    }
    const auto done = period(now);
    if (!done) return done;
    tick(trace_.rows.back());
  }
  return {};
}

Result<void> Simulation::period(TimePoint now) {
  while (next_event_ < scenario_.events.size() &&
         scenario_.events[next_event_].at_s <= seconds_at(now) + 1e-9)
    happen(scenario_.events[next_event_++], now);
  if (cameras_->due(now)) expose(now);
  if (steps_) {
    const auto done = steps_->step(now, options_.patience);
    if (!done) return done;
  }
  if (motors_) motors_->step(moment(now), *plant_);
  const auto heard = listen();
  if (!heard) return heard;
  note_turns();
  trace_.rows.push_back(row_at(now));
  if (motors_) plant_->advance(to_seconds(period_));
  return {};
}

void Simulation::happen(const Event& event, TimePoint now) {
  const TimePoint at = moment(now);
  trace_.marks.push_back({seconds_at(at), event.action.text});
  if (event.action.is_operator_command()) operator_->command(trace_.marks.size() - 1, event.action);
  Parts parts = {scenario_, *stage_, *plant_, *cameras_, motors_.get(), *lines_, intent_};
  const auto done = act(event.action, at, parts);
  if (done) return;
  notes_.push_back("'" + event.action.text + "': " + done.error().text);
  trace_.marks.back().text += ": failed";
}

Transform<World, Hand> Simulation::world_from_hand() const {
  return plant_->pose() * *rig_.body_from_hand;
}

Transform<LeftCamera, Target> Simulation::left_from_target(double time_s) const {
  return rig_.hand_from_left.inverse() * world_from_hand().inverse() *
         stage_->pose(intent_.target, time_s);
}

void Simulation::expose(TimePoint now) {
  const double time_s = seconds_at(now);
  captures_.add(now, left_from_target(time_s));
  cameras_->expose(now, time_s, stage_->scene(time_s), world_from_hand() * rig_.hand_from_left);
}

Result<void> Simulation::listen() {
  auto news = operator_->news();
  if (!news) return news.error();
  if (news->heard) heard_ = std::move(*news->heard);
  if (!heard_.visit_model.empty()) {
    intent_.target = std::max(0, stage_->find(heard_.visit_model));
    intent_.goal_m = heard_.visit_goal_m;
  }
  // A refusal is part of the story; checks say whether it should have been.
  for (const DaemonNews::Refusal& refusal : news->refusals) {
    notes_.push_back(refusal.why);
    trace_.marks[refusal.command].text += ": refused";
  }
  for (const DaemonNews::Presence& change : news->presences) {
    if (!is_attached() && !change.is_there)
      return Error{options_.gannetd + " does not answer any more"};
    trace_.marks.push_back(
        {seconds_at(change.noticed), change.is_there ? kDaemonBack : kDaemonGone});
  }
  return {};
}

void Simulation::note_turns() {
  if (!motors_) return;
  for (std::size_t i = trace_.turns.size(); i < motors_->turns().size(); ++i)
    trace_.turns.push_back({seconds_at(motors_->turns()[i].time), motors_->turns()[i].still});
}

TraceRow Simulation::row_at(TimePoint now) const {
  TraceRow row;
  row.time_s = seconds_at(now);
  row.vehicle = plant_->pose();
  row.target = world_from_hand().inverse() * stage_->pose(intent_.target, row.time_s);
  row.in_view = stage_->in_view(intent_.target, row.time_s, rig_, world_from_hand());
  row.error_m = row.target.translation - intent_.goal_m;
  row.error_rad = rotation_vector_from_quaternion(row.target.rotation).y();
  if (motors_) {
    const auto throttles = motors_->throttles();
    std::copy_n(throttles.begin(), trace_.motors, row.throttle.begin());
    row.armed = motors_->armed();
  }
  row.estop = intent_.estop;
  row.release = lines_->is_high(WorldLine::kRelease);
  row.heard = heard_;
  row.at_capture = captures_.at(start_ + from_seconds(heard_.capture_s));
  return row;
}

}  // namespace gannet::world
