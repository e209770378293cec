// The frames of ODrive's CANSimple, each described once. 11-bit ids: node id (6 bits) << 5 |
// command. Numbers go low byte first. Speeds are turns/s. Facts from ODrive's documentation of
// CANSimple (firmware 0.5.6 and 0.6) and the public firmware 0.5 (can_simple.cpp). Values; RT safe.
#pragma once

#include "hal/drive/can_signals.hpp"

namespace gannet::hal::odrive {

inline constexpr int kMaxId = 63;
inline constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;

inline constexpr Signal kError = {"AxisError", 0, 4, Coding::kUnsigned, 1, ""};
inline constexpr Signal kState = {"AxisState", 4, 1, Coding::kUnsigned, 1, ""};
inline constexpr Signal kHeartbeat[] = {
    kError,
    kState,
    {"ProcedureResult", 5, 1, Coding::kUnsigned, 1, ""},  // 0.5: flags of motor, encoder and
    {"TrajectoryDone", 6, 1, Coding::kUnsigned, 1, ""},   // controller errors
};
inline constexpr Signal kActiveErrors = {"ActiveErrors", 0, 4, Coding::kUnsigned, 1, ""};
inline constexpr Signal kDisarmReason = {"DisarmReason", 4, 4, Coding::kUnsigned, 1, ""};
inline constexpr Signal kErrors[] = {kActiveErrors, kDisarmReason};
inline constexpr Signal kRequestedState = {"RequestedState", 0, 4, Coding::kUnsigned, 1, ""};
inline constexpr Signal kEstimates[] = {
    {"Position", 0, 4, Coding::kFloat, 1, "turn"},
    {"Velocity", 4, 4, Coding::kFloat, 1, "turn/s"},
};
inline constexpr Signal kModes[] = {
    {"ControlMode", 0, 4, Coding::kUnsigned, 1, ""},
    {"InputMode", 4, 4, Coding::kUnsigned, 1, ""},
};
inline constexpr Signal kInputVelocity[] = {
    {"InputVelocity", 0, 4, Coding::kFloat, 1, "turn/s"},
    {"TorqueFeedForward", 4, 4, Coding::kFloat, 1, "Nm"},
};
inline constexpr Signal kIq[] = {
    {"IqSetpoint", 0, 4, Coding::kFloat, 1, "A"},
    {"IqMeasured", 4, 4, Coding::kFloat, 1, "A"},
};
inline constexpr Signal kTemperatures[] = {
    {"FetTemperature", 0, 4, Coding::kFloat, 1, "degC"},
    {"MotorTemperature", 4, 4, Coding::kFloat, 1, "degC"},
};
inline constexpr Signal kBus[] = {
    {"BusVoltage", 0, 4, Coding::kFloat, 1, "V"},
    {"BusCurrent", 4, 4, Coding::kFloat, 1, "A"},
};

enum Command : std::uint32_t {
  kHeartbeatId = 0x01,
  kEstop = 0x02,
  kGetError = 0x03,
  kSetAxisState = 0x07,
  kGetEstimates = 0x09,
  kSetControllerMode = 0x0B,
  kSetInputVelocity = 0x0D,
  kGetIq = 0x14,
  kGetTemperature = 0x15,  // firmware 0.5: estimates without a sensor
  kGetBus = 0x17,
  kClearErrors = 0x18,
};

inline constexpr MessageAbout kMessages[] = {
    {"Heartbeat", kHeartbeatId, 8, true, kHeartbeat},
    {"Estop", kEstop, 0, false, {}},
    {"GetError", kGetError, 8, true, kErrors},
    {"SetAxisState", kSetAxisState, 4, false, {&kRequestedState, 1}},
    {"GetEncoderEstimates", kGetEstimates, 8, true, kEstimates},
    {"SetControllerMode", kSetControllerMode, 8, false, kModes},
    {"SetInputVelocity", kSetInputVelocity, 8, false, kInputVelocity},
    {"GetIq", kGetIq, 8, true, kIq},
    {"GetTemperature", kGetTemperature, 8, true, kTemperatures},
    {"GetBusVoltageCurrent", kGetBus, 8, true, kBus},
    {"ClearErrors", kClearErrors, 0, false, {}},
};

enum AxisState : std::uint32_t { kIdle = 1, kClosedLoop = 8 };
inline constexpr std::uint32_t kVelocityControl = 2, kPassthrough = 1, kVelocityRamp = 2;

// Bits of the axis error. They moved between firmware 0.5 and 0.6.
inline constexpr std::uint32_t kWatchdog05 = 0x800, kWatchdog06 = 0x01000000;

constexpr std::uint32_t id_of(std::uint32_t command, int node) {
  return static_cast<std::uint32_t>(node) << 5 | command;
}

CanFrame frame_of(Command command, int node);  // of that message's length, all zero
CanFrame state_frame(int node, AxisState state);
CanFrame mode_frame(int node, std::uint32_t input_mode);  // velocity control
CanFrame velocity_frame(int node, double turns_per_s);

// Of the lowest bit that is set; never null.
const char* words_of_error(std::uint32_t error, bool is_firmware_05);

std::string dbc_text();  // of the node ids 1 to 8

}  // namespace gannet::hal::odrive
