#include "hal/can/socketcan_bus.hpp"

#include <algorithm>
#include <cerrno>

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

constexpr Duration kLookPeriod = milliseconds(10), kLongestBackoff = milliseconds(500);
constexpr Duration kStampSlack = milliseconds(1);  // clocks are not read at one instant
constexpr std::size_t kBatch = CanSocket::kBatch;

bool has_no_room(int error) { return error == EAGAIN || error == ENOBUFS; }
bool is_link_error(int error) { return error == ENETDOWN || error == ENODEV || error == ENXIO; }

}  // namespace

Result<std::unique_ptr<SocketCanBus>> SocketCanBus::open(const std::string& interface,
                                                         const std::vector<CanFilter>& wanted,
                                                         int most_waiting, TimePoint,
                                                         CanCalls& calls) {
  if (auto good = CanSocket::check(interface, wanted); !good) return good.error();
  std::unique_ptr<SocketCanBus> bus(new SocketCanBus(interface, wanted, most_waiting, calls));
  const CanSocket::Failure failure = bus->open_socket();
  if (failure.step != CanSocket::Step::kDone) return bus->socket_.explain(failure);
  return bus;
}

CanCounters SocketCanBus::counters() const {
  CanCounters counters = counters_;
  counters.receive_dropped += socket_.dropped();  // beside what the controller lost
  return counters;
}

// ---- the link -----------------------------------------------------------------------------------

CanSocket::Failure SocketCanBus::open_socket() {
  emptied_ = monotonic();
  const CanSocket::Failure failure = socket_.open();
  if (failure.step != CanSocket::Step::kDone) return failure;
  read_link();
  // Binding to an interface that is down leaves an error in the socket, which would else be taken
  // for another loss once it is up.
  if (link_ == Link::kDown) socket_.receive(std::span(arrivals_).first(1));
  return {};
}

// What the interface says of itself now. An interface without a carrier is a controller that is
// off the bus.
void SocketCanBus::read_link() {
  const int flags = socket_.flags();
  link_ = flags < 0 ? Link::kGone : (flags & IFF_UP) != 0 ? Link::kUp : Link::kDown;
  has_carrier_ = flags >= 0 && (flags & IFF_RUNNING) != 0;
  if (link_ == Link::kUp) health_.restart(has_carrier_);
}

bool SocketCanBus::is_up(TimePoint now) {
  if (link_ == Link::kUp) {
    if (health_.state() == BusState::kOff) check_carrier(now);
    return true;
  }
  if (now < next_look_) return false;
  const int index = socket_.interface_index();
  if (link_ == Link::kDown && index == socket_.bound_index()) {
    read_link();
    next_look_ = now + kLookPeriod;
  } else if (index < 0 || open_socket().step != CanSocket::Step::kDone) {
    link_ = Link::kGone;
    backoff_ = std::clamp(backoff_ * 2, kLookPeriod, kLongestBackoff);
    next_look_ = now + backoff_;
  } else {
    backoff_ = {};
    next_look_ = now + kLookPeriod;
  }
  return link_ == Link::kUp;
}

// The error frame that tells of the restart can get lost; the carrier that comes back cannot.
void SocketCanBus::check_carrier(TimePoint now) {
  if (now < next_look_) return;
  next_look_ = now + kLookPeriod;
  const int flags = socket_.flags();
  if (flags < 0) return;
  const bool has_carrier = (flags & IFF_RUNNING) != 0;
  if (has_carrier && !has_carrier_) health_.restart(true);
  has_carrier_ = has_carrier;
}

void SocketCanBus::note_error(int error, TimePoint now) {
  if (!is_link_error(error)) return;  // no room, or interrupted: the next cycle tries again
  if (link_ == Link::kUp) ++counters_.links_lost;
  // What is down is looked at in the next call at the earliest, so that a loss, however short, is
  // seen by whoever asks for the state.
  if (link_ != Link::kGone) link_ = error == ENETDOWN ? Link::kDown : Link::kGone;
  next_look_ = now + kLookPeriod;
}

// ---- frames -------------------------------------------------------------------------------------

int SocketCanBus::send(std::span<const CanFrame> frames, TimePoint now) {
  std::size_t taken = 0;
  if (is_up(now) && health_.state() != BusState::kOff) {
    while (taken < frames.size()) {
      const std::size_t count = std::min(kBatch, frames.size() - taken);
      const int sent = socket_.send(frames.subspan(taken, count));
      if (sent < 0) note_error(-sent, now);
      if (has_no_room(-sent)) counters_.send_no_room += frames.size() - taken;
      if (sent <= 0) break;
      taken += static_cast<std::size_t>(sent);  // of a part, the next call tells what ended it
    }
  }
  counters_.sent += taken;
  counters_.send_refused += frames.size() - taken;
  return static_cast<int>(taken);
}

int SocketCanBus::receive(std::span<ReceivedCanFrame> frames, TimePoint now) {
  std::size_t filled = 0;
  // Error frames fill nothing but cost a read: the bound keeps the call's time bounded.
  std::size_t reads = 2 * frames.size() + 2 * kBatch;
  while (filled < frames.size() && reads > 0 && is_up(now)) {
    const std::size_t count = std::min({kBatch, frames.size() - filled, reads});
    const TimePoint before = monotonic();
    const int n = socket_.receive(std::span(arrivals_).first(count));
    if (n < 0) note_error(-n, now);
    const auto arrived = static_cast<std::size_t>(std::max(n, 0));
    filled += hand_out(std::span(arrivals_).first(arrived), frames.subspan(filled), now);
    reads -= count;
    if (arrived == count) continue;
    emptied_ = before;
    break;
  }
  counters_.received += filled;
  return static_cast<int>(filled);
}

// Returns how many of them were data frames.
std::size_t SocketCanBus::hand_out(std::span<const CanArrival> arrivals,
                                   std::span<ReceivedCanFrame> frames, TimePoint now) {
  if (arrivals.empty()) return 0;
  // Both clocks after the frames: no stamp can be later.
  const Duration realtime(calls_.clock_ns(CLOCK_REALTIME));
  const TimePoint monotonic_now = monotonic();
  const Clocks clocks = {monotonic_now, realtime - monotonic_now.time_since_epoch()};
  std::size_t filled = 0;
  for (const CanArrival& arrival : arrivals) {
    if (!arrival.is_frame) {
      ++counters_.malformed;
    } else if (arrival.frame.error) {
      health_.take(arrival.frame, counters_);
    } else {
      frames[filled].frame = arrival.frame;
      frames[filled].time = arrival.has_stamp ? time_of(arrival.stamp, clocks, now) : now;
      ++filled;
    }
  }
  return filled;
}

TimePoint SocketCanBus::time_of(Duration stamp, const Clocks& clocks, TimePoint now) {
  const TimePoint time = TimePoint(stamp - clocks.realtime_offset);
  if (time <= clocks.monotonic + kStampSlack && time >= emptied_ - kStampSlack) {
    return std::min(time, clocks.monotonic);
  }
  ++counters_.clock_steps;
  return now;
}

}  // namespace gannet::hal
