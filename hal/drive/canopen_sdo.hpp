// SdoClient: reads and writes objects of one CANopen node by expedited SDO, one request at a time,
// without blocking: the caller starts a request, puts out what poll() gives, and hands in the
// answers. An unanswered request is repeated, then given up with an abort, as CiA 301 wants.
// Objects have at most four bytes; a segmented answer is refused. Source: CiA 301, 7.2.4.
//   request  40 index sub                write  2F (1 byte) 2B (2) 23 (4) index sub data
//   answer   4F 4B 43 index sub data     60 index sub           80 index sub code: abort, both ways
// RT safe.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/can/can_frame.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal::canopen {

struct ObjectId {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  friend bool operator==(const ObjectId&, const ObjectId&) = default;
};

inline constexpr std::uint32_t kAbortTimedOut = 0x05040000, kAbortBadCommand = 0x05040001,
                               kAbortUnsupported = 0x06010000, kAbortWriteOnly = 0x06010001,
                               kAbortReadOnly = 0x06010002, kAbortNoObject = 0x06020000,
                               kAbortNotMappable = 0x06040041, kAbortPdoTooLong = 0x06040042,
                               kAbortIncompatible = 0x06040043, kAbortWrongLength = 0x06070010,
                               kAbortNoSub = 0x06090011, kAbortOutOfRange = 0x06090030,
                               kAbortWrongState = 0x08000022;

// "the object does not exist" for 0x06020000; never null.
const char* words_of_abort(std::uint32_t code);

CanFrame sdo_read_request(int node, ObjectId object);
CanFrame sdo_write_request(int node, ObjectId object, std::uint32_t value, int bytes);
CanFrame sdo_abort(int node, ObjectId object, std::uint32_t code);

enum class SdoStatus : std::uint8_t { kIdle, kWaiting, kDone, kAborted, kTimedOut };

class SdoClient {
 public:
  static constexpr int kAttempts = 3;

  SdoClient(int node, Duration timeout) : node_(node), timeout_(timeout) {}

  // Each forgets what was under way.
  void read(ObjectId object);
  void write(ObjectId object, std::uint32_t value, int bytes);
  void cancel() { status_ = SdoStatus::kIdle; }

  // What is to be sent now, if anything.
  std::optional<CanFrame> poll(TimePoint now);

  // Takes an answer of this node (id 580 + node). False: malformed. Answers to what nobody asked
  // are counted and ignored.
  bool receive(const CanFrame& frame);

  SdoStatus status() const { return status_; }
  std::uint32_t value() const { return value_; }  // read, zero-extended
  int bytes() const { return bytes_; }            // of it, as the node said
  std::uint32_t abort_code() const { return abort_code_; }
  std::uint64_t unexpected() const { return unexpected_; }

 private:
  void start(const CanFrame& request, ObjectId object, bool is_read);
  void refuse(std::uint32_t code);

  const int node_;
  const Duration timeout_;
  CanFrame request_;
  ObjectId object_;
  bool is_read_ = false;
  bool owes_abort_ = false;  // the node still waits for the end of what we have given up
  SdoStatus status_ = SdoStatus::kIdle;
  int attempts_ = 0;
  TimePoint sent_ = {};
  std::uint32_t value_ = 0, abort_code_ = 0;
  int bytes_ = 0;
  std::uint64_t unexpected_ = 0;
};

}  // namespace gannet::hal::canopen
