// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "commands.hpp"
#include "open_folder.hpp"
#include "report/json_output.hpp"
#include "rprr_eval/codec/codec_survey.hpp"
#include "rprr_sensor/recordings/tum_folder.hpp"

namespace rprr {
namespace {

namespace fs = std::filesystem;

struct CodecArguments {
  std::vector<std::string> folders;
  std::vector<std::string> codecs;
  std::string json;
  std::string markdown;
  int quality = 6;
  int repeats = 3;
  int draws = 3;
  bool colour = true;
};

struct Images {
  std::vector<DepthFrame> depth;
  std::vector<cv::Mat> bgr;
};

// A TUM-layout folder, or any folder with 16-bit PNG images in it.
Result<Images> read_images(const std::string& path) {
  Images images;
  if (fs::exists(path + "/associations.txt") || fs::exists(path + "/depth.txt")) {
    const Result<TumFolder> folder = open_folder(path);
    if (!folder) return Error{folder.reason()};
    for (const RgbdEntry& entry : folder->entries) {
      const Result<RgbdImage> image = folder->load(entry);
      if (!image) return Error{image.reason()};
      images.depth.push_back(image->depth);
      images.bgr.push_back(image->bgr);
    }
    return images;
  }
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(path, error)) {
    if (file.path().extension() == ".png") files.push_back(file.path().string());
  }
  if (error) return Error{path + ": " + error.message()};
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    const cv::Mat image = cv::imread(file, cv::IMREAD_UNCHANGED);
    if (image.type() == CV_16UC1) images.depth.push_back({image, 0.001});
  }
  if (images.depth.empty()) return Error{path + " holds no depth images (16-bit PNG)"};
  return images;
}

nlohmann::json json_of(const CodecFigures& figures) {
  nlohmann::json line = {{"codec", figures.codec},         {"folder", figures.folder},
                         {"frames", figures.frames},       {"ratio", figures.ratio},
                         {"encode_ms", figures.encode_ms}, {"decode_ms", figures.decode_ms},
                         {"lossless", figures.lossless}};
  if (figures.colour && !figures.lossless) line["psnr"] = figures.psnr;
  for (const SparseFigures& sparse : figures.sparse) {
    line["sparse"].push_back({{"share", sparse.share},
                              {"bits_per_pixel", sparse.bits_per_pixel},
                              {"relative_bits", sparse.relative_bits},
                              {"mask_bytes", sparse.mask_bytes}});
  }
  return line;
}

std::vector<CodecFigures> survey(const std::string& name, const Images& images,
                                 const std::vector<NamedDepthCodec>& codecs,
                                 const CodecArguments& arguments) {
  auto figures = survey_depth(name, images.depth, codecs, arguments.repeats);
  for (std::size_t i = 0; i < codecs.size(); ++i) {
    if (!codecs[i].ours || arguments.draws == 0) continue;
    figures[i].sparse =
        survey_sparse(images.depth, *codecs[i].ours, {0.3, 0.1, 0.02}, arguments.draws);
  }
  if (images.bgr.empty() || !arguments.colour) return figures;
  const auto encoder = make_colour_encoder("pgf");
  const auto decoder = make_local_colour_decoder();
  figures.push_back(
      survey_colour(name, images.bgr, **encoder, arguments.quality, *decoder, arguments.repeats));
  figures.back().codec += std::to_string(arguments.quality);
  return figures;
}

bool write_markdown(const std::string& path, const std::vector<CodecFigures>& figures) {
  ResultFile file(path);
  file.stream() << codec_tables(figures);
  if (!file.finish()) std::cerr << file.problem() << "\n";
  return file.problem().empty();
}

int run_codec(const CodecArguments& arguments) {
  cv::setNumThreads(1);  // figures are per core
  std::vector<std::string> notes;
  const auto codecs = make_depth_codecs(arguments.codecs, notes);
  if (!codecs) return std::cerr << codecs.reason() << "\n", 1;
  for (const std::string& note : notes) std::cerr << "left out: " << note << "\n";
  JsonOutput json(arguments.json);
  if (!json.good()) return 1;
  std::vector<CodecFigures> all;
  for (const std::string& path : arguments.folders) {
    const Result<Images> images = read_images(path);
    if (!images) return std::cerr << images.reason() << "\n", 1;
    const std::string name = fs::path(path + "/").parent_path().filename().string();
    std::cerr << name << ": " << images->depth.size() << " frames\n";
    for (const CodecFigures& figures : survey(name, *images, *codecs, arguments)) {
      json.write(json_of(figures));
      all.push_back(figures);
    }
  }
  const bool lossless = std::all_of(all.begin(), all.end(), [](const CodecFigures& figures) {
    return figures.colour || figures.lossless;
  });
  if (!lossless) std::cerr << "a depth codec did not give back what it was given\n";
  const bool written = arguments.markdown.empty() || write_markdown(arguments.markdown, all);
  return json.finish(lossless && written ? 0 : 1);
}

std::string known_codecs() {
  std::string text;
  for (const DepthCodecEntry& entry : depth_codecs()) {
    text += "\n  " + entry.name + ": " + entry.description;
  }
  return text;
}

}  // namespace

void add_codec_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CodecArguments>();
  CLI::App* command = app.add_subcommand(
      "codec",
      "Codecs over folders of frames, side by side: ratio to raw (16-bit depth, 24-bit colour), "
      "medians of milliseconds of processor time a frame, one JSON object a line");
  command->add_option("folder", arguments->folders, "TUM-layout folders, or folders of 16-bit PNG")
      ->required();
  command
      ->add_option("--codecs", arguments->codecs,
                   "depth codecs, separated by commas; all if not given:" + known_codecs())
      ->delimiter(',');
  command
      ->add_option("--quality", arguments->quality,
                   "quality of PGF, from 0 (lossless) to 30 (coarsest)")
      ->check(CLI::Range(0, 30))
      ->capture_default_str();
  command->add_flag("!--no-colour", arguments->colour, "leave out PGF");
  command->add_option("--repeats", arguments->repeats, "runs of each frame; the fastest counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--draws", arguments->draws,
                   "random masks for each frame and share of blocks (30, 10, 2%) in DHC-M's sparse "
                   "figures; 0 leaves them out")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write the JSON lines here");
  command->add_option("--markdown", arguments->markdown, "write tables for people here");
  command->callback([arguments, &exit_code] { exit_code = run_codec(*arguments); });
}

}  // namespace rprr
