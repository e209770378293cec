// help_text() and man_page() of command_line.hpp.
#include <algorithm>

#include "platform/base/command_line.hpp"
#include "platform/base/command_words.hpp"

namespace gannet {
namespace {

const Argument kHelp{.name = "help",
                     .letter = 'h',
                     .kind = ArgumentKind::kFlag,
                     .help = "Print this help and exit."};
const Argument kVersion{
    .name = "version", .kind = ArgumentKind::kFlag, .help = "Print the version and exit."};

// "[mm, 10 to 10000; default 400]"
std::string facts(const Argument& a) {
  std::vector<std::string> facts;
  if (!a.unit.empty()) facts.push_back(a.unit);
  const std::string range = range_text(a);
  if (!range.empty()) facts.push_back(range);
  if (a.repeats) facts.push_back("may be repeated");
  std::string text = joined(facts, ", ");
  if (!a.preset.empty()) text += (text.empty() ? "" : "; ") + ("default " + a.preset);
  return text.empty() ? "" : " [" + text + "]";
}

std::string full_help(const Argument& a) {
  const std::string choices = a.choices.empty() ? "" : " One of " + joined(a.choices, ", ") + ".";
  return a.help + choices + facts(a);
}

std::string usage(const Command& command) {
  std::string text = command.name;
  if (!command.subcommands.empty()) text += " SUBCOMMAND …";
  for (const Argument& a : command.options)
    if (a.required) text += " --" + a.name + " " + a.value;
  text += " [options]";
  for (const Argument& a : command.positionals) {
    const std::string shown = a.name + (a.repeats ? " …" : "");
    text += " " + (a.required ? shown : "[" + shown + "]");
  }
  return text;
}

// Bytes that begin a character; continuation bytes of UTF-8 take no column.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string wrapped(std::string_view text, std::size_t indent) {
  const std::size_t width = 92;
  std::string out;
  std::size_t column = indent;
  for (const std::string& word : split(text, ' ')) {
    if (column > indent && column + 1 + columns(word) > width) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += columns(word);
  }
  return out;
}

std::string option_head(const Argument& a) {
  const std::string letter = a.letter != 0 ? std::string("-") + a.letter + ", " : "";
  return letter + "--" + a.name + (a.kind == ArgumentKind::kFlag ? "" : " " + a.value);
}

std::string help_entry(const std::string& head, const std::string& help) {
  const std::size_t indent = 28;
  std::string text = "  " + head;
  const std::size_t used = columns(text);
  text += used + 2 <= indent ? std::string(indent - used, ' ') : "\n" + std::string(indent, ' ');
  return text + wrapped(help, indent) + "\n";
}

std::string indented(const std::string& lines) {
  std::string text;
  for (const std::string& line : split(lines, '\n')) text += "  " + line + "\n";
  return text;
}

}  // namespace

std::string help_text(const Command& command) {
  std::string text = command.name + ": " + command.summary + "\n\nUsage: " + usage(command) + "\n";
  for (const std::string& paragraph : split(command.description, '\n'))
    if (!paragraph.empty()) text += "\n" + wrapped(paragraph, 0) + "\n";
  if (!command.subcommands.empty()) text += "\nSubcommands:\n";
  for (const auto& [words, summary] : command.subcommands) text += help_entry(words, summary);
  if (!command.positionals.empty()) text += "\nArguments:\n";
  for (const Argument& a : command.positionals) text += help_entry(a.name, full_help(a));
  text += "\nOptions:\n";
  for (const Argument& a : command.options) text += help_entry(option_head(a), full_help(a));
  for (const Argument* a : {&kHelp, &kVersion}) text += help_entry(option_head(*a), a->help);
  if (!command.example.empty()) text += "\nExample:\n" + indented(command.example);
  if (!command.exit_codes.empty()) text += "\nExit code:\n" + indented(command.exit_codes);
  return text;
}

// ---- man page -----------------------------------------------------------------------------------

namespace {

// Text for roff: backslash and hyphen keep their look, a line never begins with a command.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool line_begins = out.empty() || out.back() == '\n';
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string man_name(const Command& command) {
  std::string name = command.name;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string man_entry(const std::string& head, const Argument& a) {
  return ".TP\n.B " + roff(head) + "\n" + roff(full_help(a)) + "\n";
}

std::string literal(const std::string& lines) {
  return ".nf\n.RS 4\n" + roff(lines) + "\n.RE\n.fi\n";
}

}  // namespace

std::string man_page(const Command& command) {
  std::string text = ".\\\" Made from the program's own description; do not edit.\n";
  text += ".TH " + man_name(command) + " " + std::to_string(command.section) + " \"\" \"Gannet " +
          GANNET_VERSION + "\" \"Gannet\"\n";
  text += ".SH NAME\n" + roff(man_name(command)) + " \\- " + roff(command.summary) + "\n";
  text += ".SH SYNOPSIS\n.B " + roff(usage(command)) + "\n.SH DESCRIPTION\n";
  bool first = true;
  for (const std::string& paragraph : split(command.description, '\n')) {
    if (paragraph.empty()) continue;
    text += (first ? "" : ".PP\n") + roff(paragraph) + "\n";
    first = false;
  }
  for (const auto& [words, summary] : command.subcommands)
    text += ".TP\n.B " + roff(words) + "\n" + roff(summary) + "\n";
  for (const Argument& a : command.positionals) text += man_entry(a.name, a);
  text += ".SH OPTIONS\n";
  for (const Argument& a : command.options) text += man_entry(option_head(a), a);
  text += man_entry(option_head(kHelp), kHelp) + man_entry(option_head(kVersion), kVersion);
  if (!command.exit_codes.empty()) text += ".SH EXIT STATUS\n" + literal(command.exit_codes);
  if (!command.example.empty()) text += ".SH EXAMPLE\n" + literal(command.example);
  if (!command.see_also.empty()) text += ".SH SEE ALSO\n" + roff(command.see_also) + "\n";
  return text;
}

}  // namespace gannet
