#include "src/image_file/image_file.hpp"

#include <gtest/gtest.h>

#include "platform/linux/whole_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::image_file {
namespace {

class ImageFile : public ::testing::Test {
 protected:
  std::string path(const char* name) const { return folder_ / name; }
  const test::TemporaryFolder folder_;
};

TEST_F(ImageFile, is_read_by_its_content_and_not_by_its_name) {
  hal::Image image(16, 8, hal::PixelFormat::kRgb24);
  image.plane(0)[0] = 200;
  ASSERT_TRUE(write_png(path("really_png.jpg"), image.view()));
  ASSERT_TRUE(write_jpeg(path("really_jpeg.png"), image.view()));
  const auto png = read_image(path("really_png.jpg"));
  ASSERT_TRUE(png);
  EXPECT_EQ(png->format(), hal::PixelFormat::kRgb24);
  EXPECT_EQ(png->plane(0)[0], 200);
  const auto jpeg = read_image(path("really_jpeg.png"));
  ASSERT_TRUE(jpeg);
  EXPECT_EQ(jpeg->format(), hal::PixelFormat::kYuv444);
}

TEST_F(ImageFile, errors_name_the_file) {
  ASSERT_TRUE(linux_os::write_file(path("text.png"), std::string("no picture")));
  EXPECT_EQ(read_image(path("text.png")).error().text,
            path("text.png") + ": neither a PNG nor a JPEG");
  ASSERT_TRUE(linux_os::write_file(path("empty.jpg"), std::string()));
  EXPECT_EQ(read_image(path("empty.jpg")).error().text, path("empty.jpg") + ": the file is empty");
  EXPECT_EQ(read_png_rgba(path("text.png")).error().text, path("text.png") + ": not a PNG");
  EXPECT_FALSE(read_image(path("missing.png")));
  EXPECT_FALSE(write_png(path("no/folder.png"), hal::Image(2, 2, hal::PixelFormat::kRgb24).view()));
}

TEST_F(ImageFile, a_mask_is_the_alpha_where_there_is_one_and_the_brightness_otherwise) {
  const auto values = [&](const char* name) {
    const auto mask = read_mask(path(name));
    return std::vector<int>(mask->samples.begin(), mask->samples.end());
  };
  Raster8 rgba(2, 1, 4);
  rgba.samples = {255, 255, 255, 0, 0, 0, 0, 255};
  ASSERT_TRUE(write_png(path("alpha.png"), rgba));
  EXPECT_EQ(values("alpha.png"), (std::vector{0, 255}));
  Raster8 grey(2, 1, 1);
  grey.samples = {0, 1};
  ASSERT_TRUE(write_png(path("grey.png"), grey));
  EXPECT_EQ(values("grey.png"), (std::vector{0, 1}));
  Raster16 deep(4, 1, 1);
  deep.samples = {0, 1, 128, 0xffff};
  ASSERT_TRUE(write_png(path("deep.png"), deep));
  EXPECT_EQ(values("deep.png"), (std::vector{0, 1, 1, 255}));
  hal::Image rough(2, 1, hal::PixelFormat::kYuv444);
  for (std::uint8_t& byte : rough.bytes()) byte = 128;
  rough.row(0, 0)[0] = 3;
  rough.row(0, 0)[1] = 250;
  ASSERT_TRUE(write_jpeg(path("rough.jpg"), rough.view(), 95));
  EXPECT_EQ(values("rough.jpg"), (std::vector{0, 255}));
}

}  // namespace
}  // namespace gannet::image_file
