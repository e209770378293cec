// Image pairs through shared memory, from gannet-world to the daemon, without a copy. One writer,
// one reader; the layout below is the protocol (format 1).
//
// A slot's word holds the pair's number and its phase, changed by compare-and-swap alone:
//
//   free ──writer──▶ writing ──writer──▶ published ──reader──▶ held ──reader──▶ free
//                       ▲────────writer, when no slot is free────┘ (the oldest unread is given up)
//
// so a held slot is never overwritten. A reader that attaches takes over what a dead one held.
// Each pair says when its exposure was and from when it may be seen: that is how the latency of
// real cameras is simulated.
//
// The reader trusts nothing: sizes are checked once against the mapping and then only our own
// copies are used; numbers and times are checked for each pair. Who may write the file can still
// spoil pixels, or stop the daemon by truncating it: it is a file of one user, mode 0600.
// Creating and opening are start-up only (they take memory); all else is RT safe.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hal/camera/image.hpp"
#include "hal/camera/stereo_camera.hpp"
#include "platform/linux/futex.hpp"
#include "platform/linux/mapped_memory.hpp"

namespace gannet::hal {

// ---- layout: SharedHeader, SharedSlot × slots, then at a multiple of 4096 left and right image of
// each slot, as layout_of lays them out.

struct SharedHeader {
  std::atomic<std::uint64_t> magic;  // the letters GANNETFR, written last
  std::uint32_t format;
  std::uint32_t width, height;  // pixels
  std::uint32_t pixel_format, matrix, range;
  std::uint32_t slots;  // 2 … 64
  std::uint32_t reserved;
  std::uint64_t total_bytes;                  // of the whole file
  alignas(64) linux_os::FutexWord published;  // counts pairs; readers sleep on it
  std::atomic<std::uint32_t> closed;          // 1: the writer has ended in order
  std::atomic<std::uint32_t> reader;          // its process id; 0: none
};

struct SharedSlot {
  alignas(64) std::atomic<std::uint64_t> word;  // number · 4 + phase
  std::atomic<std::int64_t> capture_ns;
  std::atomic<std::int64_t> available_ns;
};

struct SharedFramesFormat {
  int width = 640;  // pixels
  int height = 480;
  PixelFormat format = PixelFormat::kYuyv;
  ColourMatrix matrix = ColourMatrix::kBt601;
  ColourRange range = ColourRange::kLimited;
  int slots = 8;

  friend bool operator==(const SharedFramesFormat&, const SharedFramesFormat&) = default;
};

// The world's end; one thread.
class SharedFramesWriter {
 public:
  // Error: the size does not suit the format, no room. Replaces a file of that name.
  static Result<SharedFramesWriter> create(const std::string& name,
                                           const SharedFramesFormat& format);
  SharedFramesWriter(SharedFramesWriter&&) noexcept = default;
  SharedFramesWriter& operator=(SharedFramesWriter&&) = delete;
  ~SharedFramesWriter();

  const ImageLayout& layout() const { return layout_; }  // of each image

  struct Images {
    std::span<std::uint8_t> left, right;
  };
  // Where to draw the next pair; empty when the reader holds all slots: then the pair is lost, and
  // counted by a gap in the numbers.
  std::optional<Images> begin_frame();
  // Hands the pair begun over. capture <= available, neither ever goes back.
  void publish(TimePoint capture, TimePoint available);

  std::uint64_t dropped() const { return dropped_; }
  bool has_reader() const;

 private:
  SharedFramesWriter() = default;
  SharedHeader& header() const;
  SharedSlot& slot(int index) const;
  bool take_free_slot();
  bool take_oldest_unread();

  mutable linux_os::MappedMemory memory_;
  SharedFramesFormat format_;
  ImageLayout layout_;
  int current_ = -1;  // slot being written
  int last_ = -1;
  std::uint64_t number_ = 0;
  std::uint64_t dropped_ = 0;
};

// The camera's end; capture thread, leases go home from any thread. Must outlive its frames.
class SharedFramesReader {
 public:
  // Error: no such file, not one of ours, its sizes do not fit, another process reads it.
  static Result<std::unique_ptr<SharedFramesReader>> open(const std::string& name);
  SharedFramesReader(const SharedFramesReader&) = delete;
  SharedFramesReader& operator=(const SharedFramesReader&) = delete;
  ~SharedFramesReader();

  const SharedFramesFormat& format() const { return format_; }

  // The oldest pair that may be seen by now: kFrame, kNothing, or kBroken (numbers or times that
  // cannot be: given back). RT safe.
  CaptureStatus take(TimePoint now, StereoFrame& frame);

  // Sleeps until a pair is published after `seen` was read, or until the time. RT safe.
  std::uint32_t published() const;
  void wait(std::uint32_t seen, TimePoint until) const;
  // From when the next unread pair may be seen; empty: none is there. RT safe.
  std::optional<TimePoint> next_available() const;

  bool closed() const;                              // by its writer
  bool all_home();                                  // no lease is out
  std::uint64_t missed() const { return missed_; }  // gaps in the numbers so far

 private:
  SharedFramesReader(linux_os::MappedMemory memory, const SharedFramesFormat& format);
  SharedHeader& header() const;
  SharedSlot& slot(int index) const;
  void give_back_returned();
  int oldest_due(TimePoint now, std::uint64_t& word) const;
  bool is_plausible(std::uint64_t number, std::int64_t capture_ns, std::int64_t available_ns) const;
  void fill(int index, StereoFrame& frame) const;

  mutable linux_os::MappedMemory memory_;
  const SharedFramesFormat format_;
  const ImageLayout layout_;
  LeasePool pool_;
  std::uint64_t held_ = 0;  // bit per slot that is held in shared memory
  std::uint64_t last_number_ = 0;
  std::int64_t last_capture_ns_ = 0;
  std::uint64_t missed_ = 0;
};

// Checks the bytes of a mapping (aligned to 64) and tells its format. Any bytes may be given.
Result<SharedFramesFormat> check_shared_frames(std::span<const std::byte> bytes);

}  // namespace gannet::hal
