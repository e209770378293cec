#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

#include "platform/linux/clock.hpp"
#include "platform/linux/whole_file.hpp"
#include "src/config/rig_file.hpp"
#include "src/control/json.hpp"
#include "src/report/progress.hpp"
#include "src/report/table.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/offline.hpp"
#include "src/track/model_search.hpp"

namespace gannet::tool {
namespace {

const char* const kName = "gannet which";
const char* const kNone = "none";

Command describe_which() {
  Command command = {
      .name = kName,
      .summary = "says which of many models is in view",
      .description =
          "Searches one pair from nothing for each model of a folder, as a vision loop does it: "
          "three models a frame with a third of --evaluations each, then the best three in full, "
          "one a frame; twelve models take seven frames. The answer is the best if it is found and "
          "its fitness 0.1 ahead of every other model's; else none.\n\n"
          "With --truth many pairs, each by itself, and a table of what was in view against what "
          "was said: a CSV with the columns frame and model beside folders left and right with "
          "FRAME.png, as `gannet-world --album` writes it.",
      .options = {rig_option(),
                  {.name = "models",
                   .value = "DIR",
                   .required = true,
                   .help = "The folder of .gannet files."},
                  {.name = "left", .value = "FILE", .help = "Left image, PNG or JPEG."},
                  {.name = "right", .value = "FILE", .help = "Right image."},
                  {.name = "truth",
                   .value = "FILE",
                   .help = "Instead: pairs whose model is known."},
                  {.name = "json", .kind = ArgumentKind::kFlag, .help = "Print as JSON."}},
      .example = "gannet which --rig rig.toml --models models --left l.png --right r.png",
      .exit_codes = "0  said\n1  none for sure; with --truth: a wrong model was said\n2  bad input",
      .see_also = "gannet-model-list(1), gannet-locate(1), gannet-world(1)"};
  command.options = joined(command.options, search_options());
  command.options.push_back(simd_option());
  return command;
}

struct Searcher {
  StereoRig rig;
  std::vector<std::string> names;
  std::unique_ptr<Parallel> workers;
  std::unique_ptr<track::ModelSearch> search;
  std::unique_ptr<vision::PreparedFrame> frame;
};

Result<Searcher> make_searcher(const Arguments& arguments) {
  Searcher out;
  const auto config = search_config(arguments, false);
  if (!config) return config.error();
  auto rig = config::load_rig(arguments.text("rig"));
  if (!rig) return rig.error();
  out.rig = *rig;
  const auto paths = model_files(arguments.text("models"));
  if (!paths) return paths.error();
  std::vector<vision::PatchModel> models;
  for (const std::string& path : *paths) {
    auto model = read_model(path, *config);
    if (!model) return model.error();
    out.names.push_back(model->name);
    models.push_back(std::move(*model));
  }
  auto workers = make_workers(arguments.integer("threads"));
  if (!workers) return workers.error();
  out.workers = std::move(*workers);
  auto search = track::ModelSearch::create(*config, out.rig, std::move(models),
                                           out.workers->workers(), arguments.text("simd"));
  if (!search) return Error{arguments.text("models") + ": " + search.error().text};
  out.search = std::move(*search);
  out.frame = std::make_unique<vision::PreparedFrame>(out.rig.left.width, out.rig.left.height,
                                                      out.search->needs());
  return out;
}

struct Verdict {
  track::ModelSearch::Answer answer;
  int frames = 0;
  double worst_ms = 0;  // of a frame
};

// The pair stands still for as many frames as it takes.
Result<Verdict> look(Searcher& searcher, const std::string& left_path,
                     const std::string& right_path) {
  const auto left = read_camera_image(left_path, searcher.rig.left, "left");
  if (!left) return left.error();
  const auto right = read_camera_image(right_path, searcher.rig.right, "right");
  if (!right) return right.error();
  if (!searcher.frame->prepare(left->view(), right->view()))
    return Error{left_path + ": the images cannot be used"};
  searcher.search->restart();
  Verdict out;
  while (!out.answer.done) {
    const TimePoint start = linux_os::monotonic_now();
    out.answer = searcher.search->look(*searcher.frame, 0, *searcher.workers);
    out.worst_ms = std::max(out.worst_ms, 1000 * to_seconds(linux_os::monotonic_now() - start));
    ++out.frames;
  }
  return out;
}

std::string name_of(const Searcher& searcher, int model) {
  return model < 0 ? kNone : searcher.names[static_cast<std::size_t>(model)];
}

int refuse(const std::string& text) {
  tell(kName, text);
  return 2;
}

int one_pair(const Arguments& arguments, Searcher& searcher) {
  const auto verdict = look(searcher, arguments.text("left"), arguments.text("right"));
  if (!verdict) return refuse(verdict.error().text);
  const auto& answer = verdict->answer;
  const Eigen::Vector3d at = answer.seen.left_from_target.translation;
  if (arguments.flag("json")) {
    control::Json json = {{"model", nullptr},
                          {"position_m", nullptr},
                          {"best", name_of(searcher, answer.best)},
                          {"fitness", answer.fitness},
                          {"ahead", answer.ahead},
                          {"frames", verdict->frames},
                          {"worst_frame_ms", verdict->worst_ms}};
    if (answer.model >= 0) {
      json["model"] = name_of(searcher, answer.model);
      json["position_m"] = {at.x(), at.y(), at.z()};
    }
    std::printf("%s\n", json.dump().c_str());
  } else if (answer.model >= 0) {
    std::printf("%s at %.1f, %.1f, %.1f mm; fitness %.3f, %.3f ahead; %d frames\n",
                name_of(searcher, answer.model).c_str(), 1000 * at.x(), 1000 * at.y(),
                1000 * at.z(), answer.fitness, answer.ahead, verdict->frames);
  } else {
    std::printf("none for sure; best %s: fitness %.3f, %.3f ahead; %d frames\n",
                name_of(searcher, answer.best).c_str(), answer.fitness, answer.ahead,
                verdict->frames);
  }
  return answer.model >= 0 ? 0 : 1;
}

struct Row {
  std::string frame, model;
};

Result<std::vector<Row>> read_truth(const std::string& path) {
  constexpr std::size_t kMostBytes = 1 << 24;
  const auto bytes = linux_os::read_file(path, kMostBytes);
  if (!bytes) return bytes.error();
  std::istringstream lines(std::string(bytes->begin(), bytes->end()));
  std::string line;
  std::getline(lines, line);
  if (!line.starts_with("frame,model")) return Error{path + ":1: wants the columns frame,model"};
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    Row row;
    if (!std::getline(cells, row.frame, ',') || !std::getline(cells, row.model, ','))
      return Error{path + ":" + std::to_string(rows.size() + 2) + ": wants frame and model"};
    rows.push_back(row);
  }
  if (rows.empty()) return Error{path + ": has no rows"};
  return rows;
}

struct Tally {
  std::map<std::string, std::map<std::string, int>> said;  // by what was in view
  int right = 0, none = 0, wrong = 0, frames = 0;
  double worst_ms = 0;
};

void print(const Tally& tally, const Searcher& searcher, bool as_json) {
  const int total = tally.right + tally.none + tally.wrong;
  if (as_json) {
    std::printf("%s\n", control::Json({{"pairs", total},
                                       {"right", tally.right},
                                       {"none", tally.none},
                                       {"wrong", tally.wrong},
                                       {"frames", tally.frames},
                                       {"said", tally.said}})
                            .dump()
                            .c_str());
    return;
  }
  std::vector<std::string> header = {"in view \\ said"};
  for (std::size_t i = 0; i < searcher.names.size(); ++i) header.push_back(std::to_string(i + 1));
  header.push_back(kNone);
  report::Table table(header);
  for (const auto& [model, counts] : tally.said) {
    std::string label = model;
    for (std::size_t i = 0; i < searcher.names.size(); ++i)
      if (searcher.names[i] == model) label = std::to_string(i + 1) + " " + model;
    std::vector<std::string> row = {label};
    const auto cell = [&, &of = counts](const std::string& said) {
      const auto at = of.find(said);
      return at == of.end() ? std::string(".") : std::to_string(at->second);
    };
    for (const std::string& name : searcher.names) row.push_back(cell(name));
    row.push_back(cell(kNone));
    table.add(row);
  }
  std::printf("%s%d pairs: %d right, %d none for sure, %d wrong; %d frames each\n",
              table.text().c_str(), total, tally.right, tally.none, tally.wrong, tally.frames);
}

int many_pairs(const Arguments& arguments, Searcher& searcher) {
  const std::string path = arguments.text("truth");
  const auto rows = read_truth(path);
  if (!rows) return refuse(rows.error().text);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const std::string below = folder.empty() ? "." : folder;
  Tally tally;
  report::Progress progress(std::cerr, report::is_terminal(STDERR_FILENO), kName,
                            static_cast<long>(rows->size()), linux_os::monotonic_now());
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const Row& row = (*rows)[i];
    const auto verdict = look(searcher, below + "/left/" + row.frame + ".png",
                              below + "/right/" + row.frame + ".png");
    if (!verdict) return refuse(verdict.error().text);
    const std::string said = name_of(searcher, verdict->answer.model);
    ++tally.said[row.model][said];
    ++(said == row.model ? tally.right : said == kNone ? tally.none : tally.wrong);
    tally.frames = std::max(tally.frames, verdict->frames);
    progress.update(static_cast<long>(i) + 1, linux_os::monotonic_now());
  }
  progress.finish(linux_os::monotonic_now());
  print(tally, searcher, arguments.flag("json"));
  return tally.wrong == 0 ? 0 : 1;
}

int run(const Arguments& arguments) {
  const bool pair = arguments.given("left") && arguments.given("right");
  if (pair == arguments.given("truth") || arguments.given("left") != arguments.given("right"))
    return refuse("one pair is --left with --right, many are --truth");
  auto searcher = make_searcher(arguments);
  if (!searcher) return refuse(searcher.error().text);
  return pair ? one_pair(arguments, *searcher) : many_pairs(arguments, *searcher);
}

}  // namespace

Subcommand which_subcommand() { return {describe_which(), &run}; }

}  // namespace gannet::tool
