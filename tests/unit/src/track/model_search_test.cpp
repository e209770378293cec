#include "src/track/model_search.hpp"

#include <gtest/gtest.h>

#include "src/vision/prepared_frame.hpp"
#include "tests/support/flat_scene.hpp"

namespace gannet::track {
namespace {

// Targets of the same shape and size that differ in what is printed on them.
test::FlatScene scene_of(int which) {
  test::FlatScene scene;
  scene.target = test::Texture(static_cast<std::uint64_t>(50 + which), 0.05, 35);
  return scene;
}

std::vector<vision::PatchModel> models_of(int count) {
  std::vector<vision::PatchModel> out;
  for (int i = 0; i < count; ++i) out.push_back(scene_of(i).model(300).value());
  return out;
}

TrackConfig config() {
  TrackConfig out;
  out.tilt_deg = 20;
  return out;
}

struct Seen {
  ModelSearch::Answer answer;
  int frames = 0;
};

// Shown: the number of a texture at a pose, or nothing.
Seen look(ModelSearch& sut, int shown, const Transform<LeftCamera, Target>* pose) {
  const test::FlatScene scene = scene_of(shown);
  const test::Picture left = scene.see(true, pose, 1), right = scene.see(false, pose, 2);
  vision::PreparedFrame frame(scene.rig.left.width, scene.rig.left.height, sut.needs());
  frame.prepare(left.view(), right.view());
  Serial serial;
  Seen out;
  while (!out.answer.done && out.frames < 100) {
    out.answer = sut.look(frame, 6000, serial);
    ++out.frames;
  }
  return out;
}

const auto kPose = test::pose_at(0.08, 0.02, 0.6, 6, -9, 15);

TEST(ModelSearch, SaysWhichOfFourIsInView) {
  const auto sut = ModelSearch::create(config(), scene_of(0).rig, models_of(4)).value();
  for (const int shown : {0, 3}) {
    const Seen seen = look(*sut, shown, &kPose);
    EXPECT_EQ(seen.answer.model, shown);
    EXPECT_GE(seen.answer.ahead, ModelSearch::kAhead);
    EXPECT_LT((seen.answer.seen.left_from_target.translation - kPose.translation).norm(), 0.01);
  }
}

TEST(ModelSearch, AnswersAfterTheFramesItSays) {
  const auto sut = ModelSearch::create(config(), scene_of(0).rig, models_of(4)).value();
  EXPECT_EQ(sut->frames(), 2 + 3);
  EXPECT_EQ(look(*sut, 1, &kPose).frames, sut->frames());
}

TEST(ModelSearch, SaysNoneWhereNoneOfThemIs) {
  const auto sut = ModelSearch::create(config(), scene_of(0).rig, models_of(3)).value();
  EXPECT_EQ(look(*sut, 0, nullptr).answer.model, -1);
  EXPECT_EQ(look(*sut, 9, &kPose).answer.model, -1);  // another texture than theirs
}

// Two models of the same thing: neither can be told from the other.
TEST(ModelSearch, SaysNoneWhereTwoFitAlike) {
  std::vector<vision::PatchModel> models = models_of(2);
  models.push_back(models[1]);
  const auto sut = ModelSearch::create(config(), scene_of(0).rig, models).value();
  const Seen seen = look(*sut, 1, &kPose);
  EXPECT_EQ(seen.answer.model, -1);
  EXPECT_TRUE(seen.answer.best == 1 || seen.answer.best == 2);
}

TEST(ModelSearch, OneModelNeedsNoOther) {
  const auto sut = ModelSearch::create(config(), scene_of(0).rig, models_of(1)).value();
  EXPECT_EQ(look(*sut, 0, &kPose).answer.model, 0);
}

TEST(ModelSearch, WantsAModelAndNotTooMany) {
  const auto rig = scene_of(0).rig;
  EXPECT_FALSE(ModelSearch::create(config(), rig, {}));
  const std::vector<vision::PatchModel> many(65, models_of(1)[0]);
  EXPECT_FALSE(ModelSearch::create(config(), rig, many));
}

}  // namespace
}  // namespace gannet::track
