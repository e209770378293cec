#include <gtest/gtest.h>

#include "hal/drive/cia402_drive.hpp"
#include "hal/drive/drive_kinds.hpp"
#include "hal/drive/dronecan_esc_drive.hpp"
#include "platform/base/random.hpp"
#include "tests/support/count_heap.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal {
namespace {

using namespace dronecan;

TEST(DriveNoHeap, CyclesWithAllMessagesAndForeignFramesTakeNoMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  DriveConfig config;
  for (int i = 0; i < 8; ++i) config.motors.push_back({.index = i, .node_id = 21 + i});
  auto sut = std::move(DroneCanEscDrive::create(config)).value();
  const DriveSetpoint setpoints[8] = {};
  CanFrame out[64], in[64];
  NodeInfo info;
  info.set_name("org.example.esc");
  Random random(1);
  std::uint8_t id = 0;
  const std::uint64_t before = test::heap_calls;
  for (int cycle = 0; cycle < 5000; ++cycle, id = static_cast<std::uint8_t>((id + 1) % 32)) {
    const TimePoint now(std::chrono::milliseconds(5 * cycle));
    for (std::uint8_t node = 21; node < 29; ++node) {
      TransferHeader header = {.type_id = EscStatus::kType.id, .source = node, .transfer_id = id};
      int n = to_frames(EscStatus{}, header, in);
      header.type_id = NodeStatus::kType.id;
      n += to_frames(NodeStatus{}, header, std::span(in).subspan(static_cast<std::size_t>(n)));
      header = {.kind = TransferKind::kResponse,
                .type_id = NodeInfo::kType.id,
                .source = node,
                .destination = 10,
                .transfer_id = id};
      n += to_frames(info, header, std::span(in).subspan(static_cast<std::size_t>(n)));
      for (int i = 0; i < n; ++i) sut->receive(in[i], now);
    }
    CanFrame foreign = {.id = static_cast<std::uint32_t>(random.next()) & kMaxExtendedId,
                        .extended = true,
                        .length = 8};
    foreign.data[7] = static_cast<std::uint8_t>(random.next());
    sut->receive(foreign, now);
    sut->send(setpoints, true, now, out);
    sut->health(now);
  }
  EXPECT_EQ(test::heap_calls - before, 0u);
  EXPECT_TRUE(sut->nodes()[7].has_info);
}

TEST(DriveNoHeap, CyclesOfCia402DrivesThatComeAndGoTakeNoMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  DriveConfig config;
  config.kind = "cia402";
  for (int i = 0; i < 8; ++i) config.motors.push_back({.node_id = 0x15 + i});
  auto sut = std::move(Cia402Drive::create(config)).value();
  const DriveSetpoint setpoints[8] = {};
  CanFrame out[64];
  const std::vector<CanFrame> in =
      frames_from({"715#00", "595#4300100092010200", "595#8000140100000206", "715#05",
                   "195#3706000000000000", "195#0802000000000000", "095#1043010000000000"});
  const std::uint64_t before = test::heap_calls;
  for (int cycle = 0; cycle < 5000; ++cycle) {
    const TimePoint now(std::chrono::milliseconds(5 * cycle));
    for (const CanFrame& frame : in) sut->receive(frame, now);
    sut->send(setpoints, cycle % 2 == 0, now, out);
    sut->health(now);
    if (cycle % 100 == 0) sut->reset_faults(now);
  }
  EXPECT_EQ(test::heap_calls - before, 0u);
}

TEST(DriveNoHeap, CyclesOfVescsAndOdrivesTakeNoMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  for (const char* kind : {"vesc", "odrive"}) {
    DriveConfig config;
    config.kind = kind;
    for (int i = 0; i < 8; ++i) config.motors.push_back({.node_id = 0x15 + i});
    const auto sut = std::move(make_drive_group(config)).value();
    const DriveSetpoint setpoints[8] = {};
    CanFrame out[64];
    const std::vector<CanFrame> in = frames_from(
        {"00000915#0000508C007B0041", "0000080A#1501320020000001", "2A9#0000000000000040",
         "2A1#0000000101000000", "2A1#2000000008000000", "00000915#00", "2A1#00"});
    const std::uint64_t before = test::heap_calls;
    for (int cycle = 0; cycle < 5000; ++cycle) {
      const TimePoint now(std::chrono::milliseconds(5 * cycle));
      for (const CanFrame& frame : in) sut->receive(frame, now);
      sut->send(setpoints, cycle % 500 < 250, now, out);
      sut->health(now);
      if (cycle % 100 == 0) sut->reset_faults(now);
    }
    EXPECT_EQ(test::heap_calls - before, 0u);
    EXPECT_GT(sut->malformed(), 0u) << kind;
  }
}

}  // namespace
}  // namespace gannet::hal
