// Golden frames of each message, both ways. All were made by pydronecan (github.com/DroneCAN), an
// independent implementation, from the values that stand beside them; one is a capture published
// in DroneCAN/libcanard issue 68.
#include "hal/drive/dronecan_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "platform/base/random.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal::dronecan {
namespace {

template <class Message>
Texts written(const Message& message, TransferHeader header) {
  header.type_id = Message::kType.id;
  CanFrame frames[64];
  const int n = to_frames(message, header, frames);
  return texts_of(std::span(frames).first(static_cast<std::size_t>(n)));
}

// The message that these frames carry to the node `own`.
template <class Message>
Message read(const Texts& texts, TransferKind kind = TransferKind::kMessage, int own = 0) {
  TransferReceiver receiver({subscription_to<Message>(kind)}, own);
  Message message;
  int completed = 0;
  for (const CanFrame& frame : frames_from(texts)) {
    const auto transfer = receiver.receive(frame, {});
    if (!transfer) continue;
    ++completed;
    EXPECT_TRUE(decode(transfer->payload, message));
  }
  EXPECT_EQ(completed, 1);
  return message;
}

std::vector<int> commands_of(const Texts& texts) {
  const auto command = read<RawCommand>(texts);
  return {command.commands.begin(), command.commands.end()};
}

RawCommand raw_command(const std::vector<int>& commands) {
  RawCommand command;
  for (int value : commands) command.commands.push_back(static_cast<std::int16_t>(value));
  return command;
}

void expect_raw_command(const std::vector<int>& commands, const TransferHeader& header,
                        const Texts& golden) {
  EXPECT_EQ(written(raw_command(commands), header), golden);
  EXPECT_EQ(commands_of(golden), commands);
}

TEST(DroneCanMessages, NodeStatus) {
  const NodeStatus status = {
      .uptime_s = 123456, .health = 2, .mode = 1, .sub_mode = 5, .vendor_status = 0xBEEF};
  const Texts golden = {"1001552A#40E201008DEFBEC7"};
  EXPECT_EQ(written(status, {.source = 42, .transfer_id = 7}), golden);
  const auto back = read<NodeStatus>(golden);
  EXPECT_EQ(back.uptime_s, 123456u);
  EXPECT_EQ(back.health, NodeStatus::kError);
  EXPECT_EQ(back.mode, NodeStatus::kInitialization);
  EXPECT_EQ(back.sub_mode, 5);
  EXPECT_EQ(back.vendor_status, 0xBEEF);
}

TEST(DroneCanMessages, RawCommandPublishedCapture) {
  expect_raw_command({5651, 5569, 4095, 7453}, {.priority = 20, .source = 127, .transfer_id = 19},
                     {"1404067F#135B055FF3C75DD3"});
}

TEST(DroneCanMessages, RawCommandOfOneToFourEscsIsOneFrame) {
  expect_raw_command({}, {.priority = 8, .source = 10, .transfer_id = 9}, {"0804060A#C9"});
  expect_raw_command({-100}, {.priority = 8, .source = 10, .transfer_id = 31}, {"0804060A#9CFCDF"});
  expect_raw_command({8191, -8192, 0, -1}, {.priority = 8, .source = 10, .transfer_id = 3},
                     {"0804060A#FF7C0200003FFFC3"});
}

TEST(DroneCanMessages, RawCommandOfSixEscsIsTwoFrames) {
  expect_raw_command({100, -200, 300, -400, 500, -600},
                     {.priority = 8, .source = 10, .transfer_id = 5},
                     {"0804060A#DE886400E3F2C085", "0804060A#5C3EF406A3D065"});
}

TEST(DroneCanMessages, RawCommandOfEightEscsIsThreeFrames) {
  expect_raw_command({8191, -8192, 4096, -4096, 1, -1, 0, 2730},
                     {.priority = 8, .source = 10, .transfer_id = 6},
                     {"0804060A#6DCDFF7C02000486", "0804060A#00300103FFF00026", "0804060A#2A8A46"});
}

TEST(DroneCanMessages, RawCommandOfTwentyEscsIsSixFrames) {
  std::vector<int> commands;
  for (int i = 0; i < 20; ++i) commands.push_back(i * 400 - 4000);
  expect_raw_command(
      commands, {.priority = 8, .source = 10, .transfer_id = 9},
      {"0804060A#551160C3C3180C89", "0804060A#C435A0D8C38C0E29", "0804060A#543BE0F1C3E00009",
       "0804060A#2401200EC0440129", "0804060A#B4076027C0A80309", "0804060A#040E69"});
}

TEST(DroneCanMessages, EscStatus) {
  const EscStatus status = {.error_count = 70000,
                            .voltage_v = 15.5f,
                            .current_a = -2.25f,
                            .temperature_k = 310.5f,
                            .rpm = -12345,
                            .power_percent = 55,
                            .esc_index = 5};
  const Texts golden = {"10040A15#B99E70110100C08C", "10040A15#4B80C0DA5CC7CF2C",
                        "10040A15#DB944C"};
  EXPECT_EQ(written(status, {.source = 21, .transfer_id = 12}), golden);
  const auto back = read<EscStatus>(golden);
  EXPECT_EQ(back.error_count, 70000u);
  EXPECT_EQ(back.voltage_v, 15.5f);
  EXPECT_EQ(back.current_a, -2.25f);
  EXPECT_EQ(back.temperature_k, 310.5f);
  EXPECT_EQ(back.rpm, -12345);
  EXPECT_EQ(back.power_percent, 55);
  EXPECT_EQ(back.esc_index, 5);
}

TEST(DroneCanMessages, ArmingStatus) {
  EXPECT_EQ(written(dronecan::ArmingStatus{ArmingStatus::kArmed}, {.source = 10, .transfer_id = 1}),
            Texts{"10044C0A#FFC1"});
  EXPECT_EQ(read<dronecan::ArmingStatus>({"10044C0A#00C2"}).status, ArmingStatus::kDisarmed);
}

TEST(DroneCanMessages, GetNodeInfoRequest) {
  const TransferHeader header = {.kind = TransferKind::kRequest,
                                 .type_id = 1,
                                 .priority = 24,
                                 .source = 10,
                                 .destination = 21,
                                 .transfer_id = 4};
  CanFrame frame[1];
  ASSERT_EQ(disassemble(header, NodeInfo::kType.signature, {}, frame), 1);
  EXPECT_EQ(to_text(frame[0]), "1801958A#C4");
}

TEST(DroneCanMessages, GetNodeInfoAnswer) {
  NodeInfo info;
  info.status.uptime_s = 77;
  info.software_major = 1;
  info.software_minor = 2;
  info.software_flags = 1;
  info.software_commit = 0xDEADBEEF;
  info.software_crc = 0x0123456789ABCDEF;
  info.hardware_major = 3;
  info.hardware_minor = 4;
  std::iota(info.unique_id.begin(), info.unique_id.end(), std::uint8_t{0});
  info.certificate.push_back(9);
  info.certificate.push_back(8);
  info.set_name("org.example.esc");
  const Texts golden = {
      "18010A95#95754D0000000084", "18010A95#0000010201EFBE24", "18010A95#ADDEEFCDAB896704",
      "18010A95#4523010304000124", "18010A95#0203040506070804", "18010A95#090A0B0C0D0E0F24",
      "18010A95#0209086F72672E04", "18010A95#6578616D706C6524", "18010A95#2E65736344"};
  EXPECT_EQ(written(info, {.kind = TransferKind::kResponse,
                           .priority = 24,
                           .source = 21,
                           .destination = 10,
                           .transfer_id = 4}),
            golden);
  const auto back = read<NodeInfo>(golden, TransferKind::kResponse, 10);
  EXPECT_EQ(back.status.uptime_s, 77u);
  EXPECT_EQ(back.software_commit, 0xDEADBEEF);
  EXPECT_EQ(back.software_crc, 0x0123456789ABCDEFu);
  EXPECT_EQ(back.unique_id, info.unique_id);
  EXPECT_EQ(back.certificate.size(), 2);
  EXPECT_EQ(std::string(back.name.begin(), back.name.end()), "org.example.esc");
}

TEST(DroneCanMessages, AllocationRequestIsAnonymous) {
  const Texts golden = {"1048D100#65010203040506C1"};  // node 50 wanted, first part of the id
  const auto back = read<Allocation>(golden);
  EXPECT_EQ(back.node_id, 50);
  EXPECT_TRUE(back.is_first_part);
  EXPECT_EQ(back.unique_id.size(), 6);
  EXPECT_EQ(back.unique_id[5], 6);
  // Ours differs in the discriminator alone, which is free.
  const Texts own = written(back, {.source = 0, .transfer_id = 1});
  ASSERT_EQ(own.size(), 1u);
  EXPECT_EQ(own[0].substr(9), golden[0].substr(9));
  EXPECT_EQ(frames_from(own)[0].id & 0x1F0003FF, 0x10000100u);
}

TEST(DroneCanMessages, AllocationAnswerIsMultiFrame) {
  Allocation answer = {.node_id = 50, .is_first_part = false, .unique_id = {}};
  for (std::uint8_t i = 0; i < 16; ++i) answer.unique_id.push_back(i);
  const Texts golden = {"1000017F#DF63640001020381", "1000017F#0405060708090A21",
                        "1000017F#0B0C0D0E0F41"};
  EXPECT_EQ(written(answer, {.source = 127, .transfer_id = 1}), golden);
  EXPECT_EQ(read<Allocation>(golden).unique_id.size(), 16);
}

TEST(DroneCanMessages, ValuesBeyondTheirBitsSaturate) {
  EXPECT_EQ(commands_of(written(raw_command({20000, -20000}), {.source = 1})),
            (std::vector<int>{8191, -8192}));
  const EscStatus status = {.rpm = 1 << 20, .power_percent = 200, .esc_index = 40};
  const auto back = read<EscStatus>(written(status, {.source = 1}));
  EXPECT_EQ(back.rpm, (1 << 17) - 1);
  EXPECT_EQ(back.power_percent, 127);
  EXPECT_EQ(back.esc_index, 31);
}

TEST(DroneCanMessages, APayloadOfTheWrongLengthIsRefused) {
  std::uint8_t bytes[64] = {};
  const auto first = [&](std::size_t n) { return std::span<const std::uint8_t>(bytes).first(n); };
  NodeStatus node;
  EXPECT_FALSE(decode(first(6), node));
  EXPECT_TRUE(decode(first(7), node));
  EXPECT_FALSE(decode(first(8), node));
  EscStatus esc;
  EXPECT_FALSE(decode(first(13), esc));
  EXPECT_TRUE(decode(first(14), esc));
  RawCommand raw;
  EXPECT_TRUE(decode(first(35), raw));   // 20
  EXPECT_FALSE(decode(first(37), raw));  // 21
  EXPECT_FALSE(decode(first(1), raw));   // no room for one
  NodeInfo info;
  EXPECT_FALSE(decode(first(40), info));  // 41 are the least
  EXPECT_TRUE(decode(first(41), info));
  bytes[40] = 24;  // a certificate longer than what is left
  EXPECT_FALSE(decode(first(64), info));
}

TEST(DroneCanMessages, TheLongestNodeInfoFits) {
  NodeInfo info;
  while (info.certificate.push_back(0xAA)) {
  }
  info.set_name(std::string(100, 'n'));
  const Texts frames =
      written(info, {.kind = TransferKind::kResponse, .source = 1, .destination = 2});
  const auto back = read<NodeInfo>(frames, TransferKind::kResponse, 2);
  EXPECT_EQ(back.certificate.size(), 255);
  EXPECT_EQ(back.name.size(), 80);
}

TEST(DroneCanMessages, RandomCommandsComeBack) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    std::vector<int> commands(static_cast<std::size_t>(random.below(21)));
    for (int& command : commands) command = random.below(16384) - 8192;
    ASSERT_EQ(commands_of(written(raw_command(commands), {.source = 1})), commands);
  }
}

}  // namespace
}  // namespace gannet::hal::dronecan
