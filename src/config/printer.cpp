#include "src/config/printer.hpp"

#include <vector>

#include "src/config/text_visitor.hpp"

namespace gannet::config {
namespace {

std::string without_final_dot(const std::string& path) {
  return path.empty() ? path : path.substr(0, path.size() - 1);
}

// "vehicle.thruster[0]." → "vehicle.thruster"
std::string without_indices(const std::string& path) {
  std::string out;
  bool inside = false;
  for (const char c : without_final_dot(path)) {
    if (c == '[') inside = true;
    if (!inside) out += c;
    if (c == ']') inside = false;
  }
  return out;
}

std::string commented(const std::string& lines) {
  std::string out;
  bool line_begins = true;
  for (const char c : lines) {
    if (line_begins && c != '\n') out += c == '#' ? "#" : "# ";
    out += c;
    line_begins = c == '\n';
  }
  return out;
}

// In TOML the keys of a table stand before its sub-tables, in whatever order they are described,
// so each table is gathered in two parts.
class FilePrinter final : public Printer, private TextVisitor {
 public:
  Visitor& visitor() override { return *this; }
  std::string text() override {
    return "format = 1\n" + tables_.front().keys + tables_.front().tables;
  }

 private:
  struct Table {
    std::string head;
    std::string keys;
    std::string tables;
  };

  void on_field(std::string_view name, const std::string& value, std::string_view,
                const About& about) override {
    const std::string facts = facts_text(about);
    const std::string help = std::string(about.help) + (facts.empty() ? "" : " (" + facts + ")");
    tables_.back().keys += wrapped(help, "# ") + std::string(name) + " = " + value + "\n";
  }
  void on_group(std::string_view, std::string_view help) override {
    tables_.push_back({"\n" + wrapped(help, "# ") + "[" + without_indices(path()) + "]\n", "", ""});
  }
  void on_group_end() override { close(); }
  int on_list(std::string_view, int size, std::string_view help) override {
    list_help_ = std::string(help);
    sample_ = size == 0;
    return sample_ ? 1 : -1;
  }
  void on_element() override {
    const std::string help = wrapped(list_help_, "# ");
    list_help_.clear();  // above the first element only
    tables_.push_back({"\n" + help + "[[" + without_indices(path()) + "]]\n", "", ""});
  }
  void on_element_end() override {
    if (sample_) {
      Table& table = tables_.back();
      table = {commented(table.head), commented(table.keys), commented(table.tables)};
      sample_ = false;
    }
    close();
  }
  void close() {
    const Table table = std::move(tables_.back());
    tables_.pop_back();
    tables_.back().tables += table.head + table.keys + table.tables;
  }

  std::vector<Table> tables_ = {{}};
  std::string list_help_;
  bool sample_ = false;
};

class OriginPrinter final : public Printer, private TextVisitor {
 public:
  explicit OriginPrinter(const Origins& origins) : origins_(origins) {}
  Visitor& visitor() override { return *this; }
  std::string text() override { return text_; }

 private:
  void on_field(std::string_view name, const std::string& value, std::string_view,
                const About&) override {
    const std::string full = path() + std::string(name);
    const auto origin = origins_.find(full);
    const std::string from = origin == origins_.end() ? "built-in" : origin->second.text();
    text_ += full + " = " + value + "  # " + from + "\n";
  }
  const Origins& origins_;
  std::string text_;
};

// Sections in the order of the tables, each closed before its sub-tables begin.
class SectionPrinter : public Printer, protected TextVisitor {
 public:
  Visitor& visitor() override { return *this; }
  std::string text() override {
    std::string text;
    for (const auto& section : sections_) text += section.head + section.rows;
    return text;
  }

 protected:
  SectionPrinter() : sections_{{"", ""}}, open_{0} {}
  virtual std::string head(const std::string& title, const std::string& help) = 0;
  void add_row(const std::string& row) { sections_[open_.back()].rows += row; }
  bool first_row() const { return sections_[open_.back()].rows.empty(); }

 private:
  struct Section {
    std::string head;
    std::string rows;
  };
  void begin(const std::string& title, const std::string& help) {
    open_.push_back(sections_.size());
    sections_.push_back({head(title, help), ""});
  }
  void on_group(std::string_view, std::string_view help) override {
    begin("[" + without_indices(path()) + "]", std::string(help));
  }
  void on_group_end() override { open_.pop_back(); }
  int on_list(std::string_view, int, std::string_view help) override {
    list_help_ = std::string(help);
    return 1;  // one element stands for all
  }
  void on_element() override { begin("[[" + without_indices(path()) + "]]", list_help_); }
  void on_element_end() override { open_.pop_back(); }

  std::vector<Section> sections_;
  std::vector<std::size_t> open_;
  std::string list_help_;
};

class MarkdownPrinter final : public SectionPrinter {
  std::string head(const std::string& title, const std::string& help) override {
    return "\n## `" + title + "`\n\n" + help + "\n";
  }
  static std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
  }
  void on_field(std::string_view name, const std::string& value, std::string_view type,
                const About& about) override {
    if (first_row())
      add_row("\n| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n");
    add_row("| `" + std::string(name) + "` | " + std::string(type) + " | `" + cell(value) + "` | " +
            cell(facts_text(about)) + " | " + cell(about.help) + " |\n");
  }
};

class ManPrinter final : public SectionPrinter {
  static std::string roff(std::string_view text) {
    std::string out;
    for (const char c : text) {
      if (c == '\\') {
        out += "\\e";
      } else if (c == '-') {
        out += "\\-";
      } else {
        out += c;
      }
    }
    return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
  }
  std::string head(const std::string& title, const std::string& help) override {
    return ".SS " + roff(title) + "\n" + roff(help) + "\n";
  }
  void on_field(std::string_view name, const std::string& value, std::string_view,
                const About& about) override {
    const std::string facts = facts_text(about);
    add_row(".TP\n.B " + roff(name) + " = " + roff(value) + "\n" + roff(about.help) +
            (facts.empty() ? "" : " (" + roff(facts) + ")") + "\n");
  }
};

}  // namespace

std::unique_ptr<Printer> make_file_printer() { return std::make_unique<FilePrinter>(); }
std::unique_ptr<Printer> make_origin_printer(const Origins& origins) {
  return std::make_unique<OriginPrinter>(origins);
}
std::unique_ptr<Printer> make_markdown_printer() { return std::make_unique<MarkdownPrinter>(); }
std::unique_ptr<Printer> make_man_printer() { return std::make_unique<ManPrinter>(); }

}  // namespace gannet::config
