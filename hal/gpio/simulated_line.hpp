// Digital lines in a mapped file that the simulated world owns: the world writes inputs and reads
// outputs, the daemon the other way round. Each line counts its edges, so that a press between two
// reads is seen.
//
// SimulatedLines is the world's side, SimulatedInput and SimulatedOutput the daemon's. A file that
// is missing, damaged or given up by its world is Level::kUnknown, and is looked for again once a
// second. One writer a line. The daemon's side is RT safe after creation.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/gpio/digital_line.hpp"
#include "platform/base/result.hpp"
#include "platform/linux/mapped_memory.hpp"

namespace gannet::hal {

// The file: this header, then `count` lines.
struct SharedLinesHeader {
  static constexpr std::uint64_t kMagic = 0x53454e494c544e47;  // "GNTLINES"
  static constexpr std::uint32_t kFormat = 1;
  std::atomic<std::uint64_t> magic;  // 0: its world has gone
  std::uint32_t format;
  std::uint32_t count;
  std::uint8_t reserved[48];
};

struct SharedLine {
  static constexpr std::size_t kNameBytes = 40;
  char name[kNameBytes];             // ends with a zero
  std::atomic<std::uint32_t> level;  // of enum Level
  std::atomic<std::uint32_t> rises;
  std::atomic<std::uint32_t> falls;
  std::uint32_t reserved;
  std::atomic<std::int64_t> edge_time_ns;

  Level read() const;  // kUnknown for what is no level
  void write(Level level, TimePoint now);
};
static_assert(sizeof(SharedLinesHeader) == 64 && sizeof(SharedLine) == 64);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

// The world's side. All lines begin as kUnknown. Its thread alone.
class SimulatedLines {
 public:
  // name: a path, or a name in shared memory. A file of that name is replaced.
  // Error: no such place, a line's name that is empty, too long or there twice.
  static Result<SimulatedLines> create(const std::string& name,
                                       const std::vector<std::string>& lines, unsigned mode = 0660);
  SimulatedLines(SimulatedLines&&) noexcept = default;
  SimulatedLines& operator=(SimulatedLines&&) = delete;
  ~SimulatedLines();

  int size() const { return count_; }
  int find(std::string_view line) const;  // −1: none of that name
  void write(int line, Level level, TimePoint now) { at(line).write(level, now); }
  Level read(int line) const { return at(line).read(); }
  // Since the beginning: how often somebody made it high.
  std::uint32_t rises(int line) const { return at(line).rises.load(std::memory_order_acquire); }

 private:
  SimulatedLines(linux_os::MappedMemory memory, int count)
      : memory_(std::move(memory)), count_(count) {}
  SharedLine& at(int line) const;

  mutable linux_os::MappedMemory memory_;
  int count_;
};

// One line's place in a file that may come and go.
class LineMapping {
 public:
  LineMapping(const std::string& path, const std::string& line);
  ~LineMapping();
  LineMapping(const LineMapping&) = delete;
  LineMapping& operator=(const LineMapping&) = delete;

  // nullptr: there is no such line now. RT safe.
  SharedLine* line(TimePoint now);
  std::uint32_t mappings() const { return mappings_; }  // so many times it was found

 private:
  void map();
  void unmap();

  std::string path_, name_;
  void* memory_ = nullptr;
  std::size_t size_ = 0;
  SharedLine* line_ = nullptr;
  bool has_tried_ = false;
  TimePoint next_attempt_ = {};
  std::uint32_t mappings_ = 0;
};

class SimulatedInput final : public DigitalInput {
 public:
  SimulatedInput(const std::string& path, const std::string& line) : mapping_(path, line) {}
  Reading read(TimePoint now) override;

 private:
  LineMapping mapping_;
  std::uint32_t mapping_seen_ = 0;
  std::uint32_t rises_ = 0, falls_ = 0;  // at the last read
};

class SimulatedOutput final : public DigitalOutput {
 public:
  SimulatedOutput(const std::string& path, const std::string& line) : mapping_(path, line) {}
  bool write(bool high, TimePoint now) override;

 private:
  LineMapping mapping_;
};

}  // namespace gannet::hal
