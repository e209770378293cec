#include "hal/drive/canopen_sdo.hpp"

#include <algorithm>

#include "hal/drive/canopen_frames.hpp"

namespace gannet::hal::canopen {
namespace {

struct Words {
  std::uint32_t code;
  const char* text;
};
constexpr Words kAborts[] = {
    {0x05030000, "the toggle bit was not alternated"},
    {0x05040000, "the SDO transfer timed out"},
    {0x05040001, "the SDO command is unknown"},
    {0x05040005, "out of memory"},
    {0x06010000, "the object does not support this access"},
    {0x06010001, "the object is write-only"},
    {0x06010002, "the object is read-only"},
    {0x06020000, "the object does not exist"},
    {0x06040041, "the object cannot be mapped to a PDO"},
    {0x06040042, "the mapped objects are too long for a PDO"},
    {0x06040043, "parameters do not fit together"},
    {0x06040047, "the device is internally inconsistent"},
    {0x06060000, "a hardware error barred the access"},
    {0x06070010, "the value has the wrong length"},
    {0x06070012, "the value is too long"},
    {0x06070013, "the value is too short"},
    {0x06090011, "the sub-index does not exist"},
    {0x06090030, "the value is out of range"},
    {0x06090031, "the value is too high"},
    {0x06090032, "the value is too low"},
    {0x06090036, "the maximum is less than the minimum"},
    {0x060A0023, "the resource is not there"},
    {0x08000000, "general error"},
    {0x08000020, "the value cannot be stored"},
    {0x08000021, "the value cannot be stored: local control"},
    {0x08000022, "the value cannot be stored in this state"},
    {0x08000023, "there is no object dictionary"},
    {0x08000024, "no data available"},
};

constexpr std::uint8_t kReadRequest = 0x40, kWriteAnswer = 0x60, kAbort = 0x80;
constexpr int kHeader = 4;  // command, index, sub-index

CanFrame frame_of(int node, std::uint8_t command, ObjectId object, std::uint32_t data) {
  CanFrame frame = {.id = kSdoRequestBase + static_cast<std::uint32_t>(node), .length = 8};
  frame.data[0] = command;
  put(std::span(frame.data).subspan(1, 2), object.index);
  frame.data[3] = object.sub;
  put(std::span(frame.data).subspan(kHeader, 4), data);
  return frame;
}

}  // namespace

const char* words_of_abort(std::uint32_t code) {
  const auto* found =
      std::find_if(std::begin(kAborts), std::end(kAborts), [&](auto& a) { return a.code == code; });
  return found == std::end(kAborts) ? "unknown abort code" : found->text;
}

CanFrame sdo_read_request(int node, ObjectId object) {
  return frame_of(node, kReadRequest, object, 0);
}

CanFrame sdo_write_request(int node, ObjectId object, std::uint32_t value, int bytes) {
  // Download, expedited, size said: bits 2 and 3 count the bytes that hold no data.
  const auto command = static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2);
  const std::uint32_t mask = bytes == 4 ? ~0u : (1u << (8 * bytes)) - 1;
  return frame_of(node, command, object, value & mask);
}

CanFrame sdo_abort(int node, ObjectId object, std::uint32_t code) {
  return frame_of(node, kAbort, object, code);
}

void SdoClient::read(ObjectId object) { start(sdo_read_request(node_, object), object, true); }

void SdoClient::write(ObjectId object, std::uint32_t value, int bytes) {
  start(sdo_write_request(node_, object, value, bytes), object, false);
}

void SdoClient::start(const CanFrame& request, ObjectId object, bool is_read) {
  request_ = request;
  object_ = object;
  is_read_ = is_read;
  owes_abort_ = false;
  status_ = SdoStatus::kWaiting;
  attempts_ = 0;
  value_ = abort_code_ = 0;
  bytes_ = 0;
}

std::optional<CanFrame> SdoClient::poll(TimePoint now) {
  if (owes_abort_) {
    owes_abort_ = false;
    return sdo_abort(node_, object_, abort_code_);
  }
  if (status_ != SdoStatus::kWaiting) return {};
  if (attempts_ > 0 && now - sent_ < timeout_) return {};
  if (attempts_ == kAttempts) {
    status_ = SdoStatus::kTimedOut;
    abort_code_ = kAbortTimedOut;
    return sdo_abort(node_, object_, kAbortTimedOut);
  }
  // An expedited request may be repeated: it does the same again.
  ++attempts_;
  sent_ = now;
  return request_;
}

bool SdoClient::receive(const CanFrame& frame) {
  if (frame.length < kHeader) return false;
  const std::span<const std::uint8_t> data = std::span(frame.data).first(frame.length);
  const ObjectId object = {static_cast<std::uint16_t>(get(data.subspan(1, 2))), data[3]};
  const std::uint8_t command = data[0];
  if (status_ != SdoStatus::kWaiting || attempts_ == 0 || object != object_) {
    ++unexpected_;
    return true;
  }
  if (command == kAbort) {
    if (data.size() != 8) return false;
    status_ = SdoStatus::kAborted;
    abort_code_ = get(data.subspan(kHeader, 4));
    return true;
  }
  if (!is_read_) {
    // Some devices answer a write with the header alone.
    if (command != kWriteAnswer) {
      ++unexpected_;
      return true;
    }
    status_ = SdoStatus::kDone;
    return true;
  }
  const bool is_upload = (command & 0xE0) == 0x40, is_expedited = (command & 0x02) != 0;
  if (!is_upload) {
    ++unexpected_;
    return true;
  }
  if (!is_expedited) {  // longer than four bytes: none of the objects that we want is
    refuse(kAbortWrongLength);
    return true;
  }
  const bool says_size = (command & 0x01) != 0;
  const int size = says_size ? 4 - (command >> 2 & 3) : 4;
  if (kHeader + size > static_cast<int>(data.size())) return false;
  bytes_ = size;
  value_ = get(data.subspan(kHeader, static_cast<std::size_t>(size)));
  status_ = SdoStatus::kDone;
  return true;
}

void SdoClient::refuse(std::uint32_t code) {
  status_ = SdoStatus::kAborted;
  abort_code_ = code;
  owes_abort_ = true;
}

}  // namespace gannet::hal::canopen
