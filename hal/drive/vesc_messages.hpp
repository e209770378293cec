// The frames of VESC's own CAN protocol, each described once. 29-bit ids: command << 8 | id of the
// VESC (for answers to a question: of who asked). Numbers go high byte first. Speed is electrical:
// shaft rpm × pole pairs. Facts from the public firmware (comm_can.c, commands.c, datatypes.h).
// Values; RT safe.
#pragma once

#include <optional>

#include "hal/drive/can_signals.hpp"

namespace gannet::hal::vesc {

inline constexpr int kMaxId = 127;  // of the 254 that there are, as in our other protocols
inline constexpr ByteOrder kOrder = ByteOrder::kBigEndian;

inline constexpr Signal kDuty = {"Duty", 0, 4, Coding::kSigned, 1e-5, ""};
inline constexpr Signal kCurrent = {"Current", 0, 4, Coding::kSigned, 1e-3, "A"};
inline constexpr Signal kBrakeCurrent = {"BrakeCurrent", 0, 4, Coding::kSigned, 1e-3, "A"};
inline constexpr Signal kErpm = {"ElectricalSpeed", 0, 4, Coding::kSigned, 1, "rpm"};

inline constexpr Signal kStatus1[] = {
    {"ElectricalSpeed", 0, 4, Coding::kSigned, 1, "rpm"},
    {"MotorCurrent", 4, 2, Coding::kSigned, 0.1, "A"},
    {"Duty", 6, 2, Coding::kSigned, 1e-3, ""},
};
inline constexpr Signal kStatus2[] = {
    {"AmpHours", 0, 4, Coding::kSigned, 1e-4, "Ah"},
    {"AmpHoursCharged", 4, 4, Coding::kSigned, 1e-4, "Ah"},
};
inline constexpr Signal kStatus3[] = {
    {"WattHours", 0, 4, Coding::kSigned, 1e-4, "Wh"},
    {"WattHoursCharged", 4, 4, Coding::kSigned, 1e-4, "Wh"},
};
inline constexpr Signal kStatus4[] = {
    {"FetTemperature", 0, 2, Coding::kSigned, 0.1, "degC"},
    {"MotorTemperature", 2, 2, Coding::kSigned, 0.1, "degC"},
    {"InputCurrent", 4, 2, Coding::kSigned, 0.1, "A"},
    {"Position", 6, 2, Coding::kSigned, 0.02, "deg"},
};
inline constexpr Signal kStatus5[] = {
    {"Tachometer", 0, 4, Coding::kSigned, 1 / 6.0, "erev"},
    {"InputVoltage", 4, 2, Coding::kSigned, 0.1, "V"},
};
// A packet of at most 6 bytes: who sends it, 0: answer me, 1: an answer; then the packet. Ours ask
// for one of COMM_GET_VALUES_SELECTIVE's values, by a mask with one bit.
inline constexpr Signal kSender = {"Sender", 0, 1, Coding::kUnsigned, 1, ""};
inline constexpr Signal kWhat = {"IsAnswer", 1, 1, Coding::kUnsigned, 1, ""};
inline constexpr Signal kPacket = {"Packet", 2, 1, Coding::kUnsigned, 1, ""};
inline constexpr Signal kMask = {"Mask", 3, 4, Coding::kUnsigned, 1, ""};
inline constexpr Signal kValue = {"Value", 7, 1, Coding::kUnsigned, 1, ""};
inline constexpr Signal kShort[] = {kSender, kWhat, kPacket, kMask, kValue};

inline constexpr std::uint8_t kGetValuesSelective = 50;
inline constexpr std::uint32_t kFaultMask = 1u << 15, kTimeoutMask = 1u << 21;
inline constexpr int kQuestionLength = 7, kAnswerLength = 8;

inline constexpr MessageAbout kMessages[] = {
    {"SetDuty", 0, 4, false, {&kDuty, 1}},
    {"SetCurrent", 1, 4, false, {&kCurrent, 1}},
    {"SetCurrentBrake", 2, 4, false, {&kBrakeCurrent, 1}},
    {"SetRpm", 3, 4, false, {&kErpm, 1}},
    {"ShortPacket", 8, 8, false, kShort},
    {"Status", 9, 8, true, kStatus1},
    {"Status2", 14, 8, true, kStatus2},
    {"Status3", 15, 8, true, kStatus3},
    {"Status4", 16, 8, true, kStatus4},
    {"Status5", 27, 8, true, kStatus5},
};
enum Command : std::uint32_t {
  kSetDuty = 0,
  kSetCurrent = 1,
  kSetCurrentBrake = 2,
  kSetRpm = 3,
  kShortPacket = 8,
  kStatus1Id = 9,
  kStatus4Id = 16,
  kStatus5Id = 27,
};

constexpr std::uint32_t id_of(std::uint32_t command, int node) {
  return command << 8 | static_cast<std::uint32_t>(node);
}

// The bytes that this frame must have at least; 0: no message of ours. Status 5 counts up to its
// last signal: some firmware sends no more.
int least_length(std::uint32_t command);

CanFrame set_frame(Command command, const Signal& signal, int node, double value);
CanFrame question_frame(int own_id, int node, std::uint32_t mask);

struct Answer {
  int node;
  std::uint32_t mask;
  std::uint8_t value;
};
// Empty: another packet.
std::optional<Answer> answer_from(const CanFrame& frame);

// "over-voltage" for 1; never null.
const char* words_of_fault(int code);

std::string dbc_text();  // of the ids 1 to 8

}  // namespace gannet::hal::vesc
