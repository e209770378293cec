// HtmlReport: one self-contained page: headings, paragraphs, tables, plots and pictures, all
// inside the file, so that it can be mailed and kept. Light or dark as the reader has set. Words
// are escaped. Any thread, not real-time; a value.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "platform/base/result.hpp"
#include "src/report/table.hpp"

namespace gannet::report {

class HtmlReport {
 public:
  explicit HtmlReport(std::string_view title, std::string_view subtitle = "");

  void heading(std::string_view words);
  void subheading(std::string_view words);
  void paragraph(std::string_view words);
  // Cells that read "pass" or "fail" are marked by colour and sign.
  void table(const Table& table, std::string_view caption = "");
  void svg(std::string_view picture, std::string_view caption = "");
  // The bytes of a PNG or JPEG file. Error: neither of them.
  Result<void> picture(std::span<const std::uint8_t> file, std::string_view caption = "");
  // Figures (svg, picture) between the two stand beside each other where the window is wide.
  void begin_row();
  void end_row();

  std::string html() const;
  // Written beside and renamed, so that nothing is overwritten half. Error: names path and reason.
  Result<void> write(const std::string& path) const;

 private:
  void figure(std::string_view inner, std::string_view caption);
  std::string title_;
  std::string body_;
};

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace gannet::report
