#include "src/report/html_report.hpp"

#include <algorithm>

#include "platform/linux/whole_file.hpp"
#include "src/report/svg_canvas.hpp"

namespace gannet::report {
namespace {

constexpr std::string_view kStyle =
    ":root{color-scheme:light dark;--ground:#fff;--ink:#1b2127;--soft:#59626c;--rule:#d9dee3;"
    "--stripe:#f5f7f9;--accent:#0072b2;--good:#00704f;--bad:#b84300}"
    "@media (prefers-color-scheme:dark){:root{--ground:#14181c;--ink:#dfe5ea;--soft:#98a3ad;"
    "--rule:#333c45;--stripe:#1b2127;--accent:#4aa8e0;--good:#2ec79b;--bad:#ff8a47}}"
    "body{background:var(--ground);color:var(--ink);font:15px/1.5 system-ui,'DejaVu Sans',"
    "Helvetica,Arial,sans-serif;max-width:1080px;margin:2em auto;padding:0 1.2em}"
    "h1{font-size:1.7em;margin:0}h2{font-size:1.25em;margin:2em 0 .5em;padding-bottom:.2em;"
    "border-bottom:2px solid var(--accent)}h3{font-size:1.05em;margin:1.5em 0 .4em}"
    ".subtitle,caption,figcaption{color:var(--soft)}.subtitle{margin:.2em 0 1.5em}"
    "table{border-collapse:collapse;margin:1em 0;font-variant-numeric:tabular-nums}"
    "caption,figcaption{font-size:.9em;text-align:left;padding:.3em 0}"
    "th,td{padding:.28em .8em;text-align:left;border-bottom:1px solid var(--rule)}"
    "th{border-bottom:2px solid var(--rule)}tbody tr:nth-child(even){background:var(--stripe)}"
    ".n{text-align:right}.pass{color:var(--good);font-weight:600}"
    ".fail{color:var(--bad);font-weight:600}figure{margin:1em 0;overflow-x:auto}"
    "svg,img{max-width:100%;height:auto}.row{display:flex;flex-wrap:wrap;gap:1em}"
    ".row figure{flex:1 1 20em;margin:.5em 0}.wide{overflow-x:auto}";

std::string tag(std::string_view name, std::string_view words) {
  const std::string n(name);
  return "<" + n + ">" + escaped(words) + "</" + n + ">\n";
}

std::string cell(const std::string& words, bool numeric) {
  if (words == "pass") return "<td class=\"pass\">✓ pass</td>";
  if (words == "fail") return "<td class=\"fail\">✗ fail</td>";
  return std::string("<td") + (numeric ? " class=\"n\"" : "") + ">" + escaped(words) + "</td>";
}

// From a file's first bytes; empty: neither PNG nor JPEG.
std::string_view media_type(std::span<const std::uint8_t> file) {
  constexpr std::uint8_t kPng[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::uint8_t kJpeg[] = {0xff, 0xd8, 0xff};
  const auto begins = [file](std::span<const std::uint8_t> magic) {
    return file.size() > magic.size() && std::equal(magic.begin(), magic.end(), file.begin());
  };
  return begins(kPng) ? "image/png" : begins(kJpeg) ? "image/jpeg" : "";
}

}  // namespace

HtmlReport::HtmlReport(std::string_view title, std::string_view subtitle) : title_(title) {
  body_ = tag("h1", title);
  body_ += "<p class=\"subtitle\">" + escaped(subtitle) + "</p>\n";
}

void HtmlReport::heading(std::string_view words) { body_ += tag("h2", words); }
void HtmlReport::subheading(std::string_view words) { body_ += tag("h3", words); }
void HtmlReport::paragraph(std::string_view words) { body_ += tag("p", words); }
void HtmlReport::begin_row() { body_ += "<div class=\"row\">\n"; }
void HtmlReport::end_row() { body_ += "</div>\n"; }

void HtmlReport::table(const Table& table, std::string_view caption) {
  body_ += "<div class=\"wide\"><table>\n";
  if (!caption.empty()) body_ += tag("caption", caption);
  body_ += "<thead><tr>";
  for (std::size_t c = 0; c < table.header().size(); ++c) {
    body_ += std::string("<th") + (table.is_numeric(c) ? " class=\"n\"" : "") + ">" +
             escaped(table.header()[c]) + "</th>";
  }
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows()) {
    body_ += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) body_ += cell(row[c], table.is_numeric(c));
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void HtmlReport::figure(std::string_view inner, std::string_view caption) {
  body_ += "<figure>" + std::string(inner);
  if (!caption.empty()) body_ += tag("figcaption", caption);
  body_ += "</figure>\n";
}

void HtmlReport::svg(std::string_view picture, std::string_view caption) {
  figure(picture, caption);
}

Result<void> HtmlReport::picture(std::span<const std::uint8_t> file, std::string_view caption) {
  const std::string_view type = media_type(file);
  if (type.empty()) {
    return Error{"report: the picture \"" + std::string(caption) + "\" is neither PNG nor JPEG"};
  }
  figure("<img alt=\"" + escaped(caption) + "\" src=\"data:" + std::string(type) + ";base64," +
             base64(file) + "\">",
         caption);
  return {};
}

std::string HtmlReport::html() const {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n" +
         tag("title", title_) + "<style>" + std::string(kStyle) + "</style></head>\n<body>\n" +
         body_ + "</body></html>\n";
}

Result<void> HtmlReport::write(const std::string& path) const {
  return linux_os::write_file(path, html());
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(bytes.size() - i, 3);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      result += k <= n ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return result;
}

}  // namespace gannet::report
