#include "hal/drive/cia402_setup.hpp"

#include <cmath>

#include "hal/drive/canopen_frames.hpp"
#include "hal/drive/cia402_state.hpp"

namespace gannet::hal::cia402 {
namespace {

using Kind = SetupStep::Kind;
using Fact = SetupStep::Fact;
using Steps = std::vector<SetupStep>;

constexpr std::uint32_t kProfile = 402;
constexpr std::uint32_t kNotValid = 1u << 31, kNoRtr = 1u << 30;  // of a PDO's COB-ID
constexpr std::uint32_t kCobIdMask = 0xBFFFFFFF;                  // without the RTR bit
constexpr std::uint32_t kEverySync = 1, kAtOnce = 255;            // transmission types
constexpr std::uint32_t kPvMode = 3, kCsvMode = 9;                // 6060
constexpr std::uint32_t kStopAndDisable = 2;                      // 605A: ramp, then off

std::uint32_t mapping(std::uint16_t index, int bits) {
  return static_cast<std::uint32_t>(index) << 16 | static_cast<std::uint32_t>(bits);
}

std::uint32_t milliseconds(double s) { return static_cast<std::uint32_t>(std::lround(s * 1000)); }

struct Pdo {
  std::uint16_t communication = 0, map = 0;
  std::uint32_t cob_id = 0;
  std::uint32_t type = kEverySync;
  std::vector<std::uint32_t> mapped;
};

// A PDO is switched off, mapped anew and switched on. Drives with fixed mappings refuse some of
// it: what counts is what is read back.
void add_pdo(Steps& steps, const Pdo& pdo) {
  const auto count = static_cast<std::uint32_t>(pdo.mapped.size());
  const ObjectId cob_id = {pdo.communication, 1}, type = {pdo.communication, 2};
  steps.push_back({Kind::kOffer, cob_id, 4, kNotValid | pdo.cob_id});
  steps.push_back({Kind::kOffer, {pdo.map, 0}, 1, 0});
  for (std::uint8_t i = 0; i < count; ++i) {
    const auto sub = static_cast<std::uint8_t>(i + 1);
    steps.push_back({Kind::kOffer, {pdo.map, sub}, 4, pdo.mapped[i]});
  }
  steps.push_back({Kind::kOffer, {pdo.map, 0}, 1, count});
  steps.push_back({Kind::kOffer, type, 1, pdo.type});
  steps.push_back({Kind::kOffer, cob_id, 4, pdo.cob_id});
  steps.push_back({Kind::kExpect, {pdo.map, 0}, 1, count});
  for (std::uint8_t i = 0; i < count; ++i) {
    const auto sub = static_cast<std::uint8_t>(i + 1);
    steps.push_back({Kind::kExpect, {pdo.map, sub}, 4, pdo.mapped[i]});
  }
  steps.push_back({Kind::kExpect, type, 1, pdo.type});
  steps.push_back({Kind::kExpect, cob_id, 4, pdo.cob_id & kCobIdMask, kCobIdMask});
}

void add_pdos(Steps& steps, const Cia402Config& config, int node) {
  const auto id = static_cast<std::uint32_t>(node);
  const auto offset = static_cast<std::uint16_t>(config.pdo - 1);
  const bool is_cyclic = config.mode == "cyclic_velocity";
  const auto at = [](int base, int n) { return static_cast<std::uint16_t>(base + n); };
  add_pdo(steps, {.communication = at(0x1400, offset),
                  .map = at(0x1600, offset),
                  .cob_id = canopen::rpdo_base(config.pdo) + id,
                  .type = is_cyclic ? kEverySync : kAtOnce,
                  .mapped = {mapping(0x6040, 16), mapping(0x60FF, 32)}});
  Pdo tpdo = {.communication = at(0x1800, offset),
              .map = at(0x1A00, offset),
              .cob_id = kNoRtr | (canopen::tpdo_base(config.pdo) + id),
              .type = kEverySync,
              .mapped = {mapping(0x6041, 16), mapping(0x606C, 32)}};
  if (config.report_current) tpdo.mapped.push_back(mapping(0x6078, 16));
  add_pdo(steps, tpdo);
  const auto position = static_cast<std::uint16_t>(position_pdo(config) - 1);
  if (config.report_position) {
    add_pdo(steps, {.communication = at(0x1800, position),
                    .map = at(0x1A00, position),
                    .cob_id = kNoRtr | (canopen::tpdo_base(position_pdo(config)) + id),
                    .type = kEverySync,
                    .mapped = {mapping(0x6064, 32)}});
  }
  // What else the drive would say by itself is bus load without a reader.
  for (int pdo = 1; pdo <= 4; ++pdo) {
    if (pdo == config.pdo) continue;
    if (config.report_position && pdo == position_pdo(config)) continue;
    steps.push_back({Kind::kOffer,
                     {at(0x1800, pdo - 1), 1},
                     4,
                     kNotValid | kNoRtr | (canopen::tpdo_base(pdo) + id)});
  }
}

// Value times ten to the index, in seconds (60C2): the coarsest decimal that fits exactly.
void add_cycle_time(Steps& steps, double period_s) {
  int index = -3;
  double value = period_s * 1e3;
  while (index > -6 && std::fabs(value - std::round(value)) > 1e-6 && value * 10 <= 255) {
    --index;
    value *= 10;
  }
  const auto rounded = static_cast<std::uint32_t>(std::lround(std::fmin(255, value)));
  steps.push_back({Kind::kOffer, {0x60C2, 1}, 1, rounded});
  steps.push_back({Kind::kOffer, {0x60C2, 2}, 1, static_cast<std::uint32_t>(index)});
}

void add_motion(Steps& steps, const Cia402Config& config) {
  const bool is_cyclic = config.mode == "cyclic_velocity";
  const std::uint32_t mode = is_cyclic ? kCsvMode : kPvMode;
  const double units = velocity_units_per_rad_s(config);
  const auto rate = [&](double rad_s2) {
    return static_cast<std::uint32_t>(std::lround(rad_s2 * units));
  };
  steps.push_back({Kind::kWrite, {0x6060, 0}, 1, mode});
  steps.push_back({Kind::kExpectSoon, {0x6061, 0}, 1, mode});
  steps.push_back({Kind::kOffer, {0x605A, 0}, 2, kStopAndDisable});
  if (config.acceleration_rad_s2 > 0) {
    steps.push_back({Kind::kWrite, {0x6083, 0}, 4, rate(config.acceleration_rad_s2)});
    steps.push_back({Kind::kWrite, {0x6084, 0}, 4, rate(config.acceleration_rad_s2)});
  }
  if (config.quick_stop_rad_s2 > 0) {
    steps.push_back({Kind::kWrite, {0x6085, 0}, 4, rate(config.quick_stop_rad_s2)});
  }
  steps.push_back({Kind::kOffer,
                   {0x1006, 0},
                   4,
                   static_cast<std::uint32_t>(std::lround(config.servo_period_s * 1e6))});
  if (is_cyclic) add_cycle_time(steps, config.servo_period_s);
  if (config.report_current) {
    steps.push_back({.kind = Kind::kLearn, .object = {0x6075, 0}, .fact = Fact::kRatedCurrent});
  }
}

std::uint32_t abort_option(const Cia402Config& config) {  // 6007
  if (config.guard_reaction == "fault") return 1;
  return config.guard_reaction == "disable_voltage" ? 2 : 3;
}

void add_guard(Steps& steps, const Cia402Config& config, int own_node_id) {
  const std::uint32_t guard_ms = milliseconds(config.guard_time_s);
  const std::uint32_t consumer = static_cast<std::uint32_t>(own_node_id) << 16 | guard_ms;
  const ObjectId timer = {static_cast<std::uint16_t>(0x1400 + config.pdo - 1), 5};
  steps.push_back({Kind::kOffer, {0x1016, 1}, 4, consumer});
  steps.push_back(
      {.kind = Kind::kLearn, .object = {0x1016, 1}, .value = consumer, .fact = Fact::kConsumer});
  steps.push_back({Kind::kOffer, {0x1029, 1}, 1, 0});  // leave Operational
  steps.push_back({Kind::kOffer, {0x6007, 0}, 2, abort_option(config)});
  steps.push_back({.kind = Kind::kLearn, .object = {0x6007, 0}, .fact = Fact::kReaction});
  steps.push_back({.kind = Kind::kOffer,
                   .object = timer,
                   .bytes = 2,
                   .value = guard_ms,
                   .only_unguarded = true});
  steps.push_back({.kind = Kind::kLearn,
                   .object = timer,
                   .value = guard_ms,
                   .fact = Fact::kRpdoTimer,
                   .only_unguarded = true});
}

}  // namespace

Steps setup_steps(const Cia402Config& config, int node, int own_node_id) {
  Steps steps;
  steps.push_back({Kind::kExpect, {0x1000, 0}, 4, kProfile, 0xFFFF});
  // One that still runs for a daemon that died stops now: its PDOs are deaf from here on.
  steps.push_back({Kind::kOffer, {0x6040, 0}, 2, kQuickStop});
  steps.push_back({Kind::kWrite, {0x1017, 0}, 2, milliseconds(config.node_heartbeat_s)});
  add_pdos(steps, config, node);
  add_motion(steps, config);
  add_guard(steps, config, own_node_id);
  return steps;
}

}  // namespace gannet::hal::cia402
