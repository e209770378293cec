#include "src/report/html_report.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace gannet::report {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// RFC 4648, section 10.
TEST(Base64, has_the_standard_s_examples) {
  EXPECT_EQ(base64(bytes_of("")), "");
  EXPECT_EQ(base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes_of("foo")), "Zm9v");
  EXPECT_EQ(base64(bytes_of("foobar")), "Zm9vYmFy");
  EXPECT_EQ(base64(bytes_of("\xff\xfe\xfd")), "//79");
}

TEST(HtmlReport, escapes_words) {
  HtmlReport sut("a < b", "R & D");
  sut.paragraph("<script>alert(\"x\")</script>");
  Table table({"<th>"});
  table.add({"<td>"});
  sut.table(table, "<caption>");
  const std::string html = sut.html();
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_NE(html.find("R &amp; D"), std::string::npos);
  EXPECT_NE(html.find("<td>&lt;td&gt;</td>"), std::string::npos);
}

TEST(HtmlReport, is_self_contained) {
  HtmlReport sut("demo");
  const std::string png = "\x89PNG\r\n\x1a\n and so on";
  ASSERT_TRUE(sut.picture(bytes_of(png), "overlay"));
  const std::string html = sut.html();
  EXPECT_NE(html.find("data:image/png;base64," + base64(bytes_of(png))), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find("<link"), std::string::npos);
}

TEST(HtmlReport, knows_jpeg_and_refuses_what_is_no_picture) {
  HtmlReport sut("demo");
  EXPECT_TRUE(sut.picture(bytes_of("\xff\xd8\xff\xe0 JFIF"), "left"));
  EXPECT_NE(sut.html().find("image/jpeg"), std::string::npos);
  const std::string before = sut.html();
  const Result<void> refused = sut.picture(bytes_of("GIF89a"), "right");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("right"), std::string::npos);
  EXPECT_EQ(sut.html(), before);
}

TEST(HtmlReport, marks_verdicts_and_sets_numbers_right) {
  HtmlReport sut("demo");
  Table table({"check", "value", "verdict"});
  table.add({"settle", "4.2", "pass"});
  table.add({"hold", "9.9", "fail"});
  sut.table(table);
  EXPECT_NE(sut.html().find("class=\"pass\""), std::string::npos);
  EXPECT_NE(sut.html().find("class=\"fail\""), std::string::npos);
  EXPECT_NE(sut.html().find("<td class=\"n\">4.2</td>"), std::string::npos);
}

TEST(HtmlReport, writes_the_whole_page_or_nothing) {
  std::string folder = testing::TempDir() + "report_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string path = folder + "/report.html";
  HtmlReport sut("demo");
  ASSERT_TRUE(sut.write(path));
  std::ifstream in(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), sut.html());
  const std::filesystem::directory_iterator files(folder);
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "something is left beside the page";
  const Result<void> refused = sut.write(folder + "/no/such/folder.html");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find(folder + "/no/such/folder.html"), std::string::npos);
  EXPECT_NE(refused.error().text.find("No such file"), std::string::npos);
  unlink(path.c_str());
  rmdir(folder.c_str());
}

}  // namespace
}  // namespace gannet::report
