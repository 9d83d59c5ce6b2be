#include "box.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <utility>
#include <vector>

#include "environment.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/places.hpp"
#include "saphira/cli/supervisor.hpp"

namespace saphira::console {

namespace {

namespace fs = std::filesystem;

constexpr double kDelay = 5.0;              // [s]
constexpr double kDelayWhileDriven = 30.0;  // [s] of the minute that the others keep
constexpr std::size_t kMostFiles = 20;
constexpr std::uintmax_t kMostBytes = 200'000'000;

/// Removes the oldest recordings: their names have their times.
void prune(const std::string& folder) {
  std::error_code none;
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(folder, none))
    if (file.path().extension() == ".mcap" || file.path().extension() == ".new")  // not ended
      files.push_back(file.path());
  std::ranges::sort(files, std::greater<>());
  std::uintmax_t bytes = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    bytes += fs::file_size(files[i], none);
    if (i >= kMostFiles || bytes > kMostBytes)
      fs::remove(files[i], none);
  }
}

}  // namespace

Box::Box(std::string folder, bus::NodeOptions options)
    : folder_(std::move(folder)), options_(std::move(options)) {}

Box::~Box() {
  if (recorder_ > 0) {
    ::kill(recorder_, SIGTERM);
    ::waitpid(recorder_, nullptr, 0);
  }
}

void Box::keep(const situation::Occasion& occasion, double now) {
  if (recorder_ > 0 || occasion_)
    return;
  occasion_ = now;
  file_ =
      folder_ + "/" + local_text(std::time(nullptr), "%Y-%m-%d-%H%M%S-") + occasion.kind + ".mcap";
  text_ = occasion.text;
}

void Box::start() {
  std::error_code none;
  fs::create_directories(folder_, none);
  std::vector<std::string> words{program_folder() + "/saphira-record", "--last-minute", file_};
  auto own = cli::as_environment(options_);
  std::erase_if(own, [](const auto& variable) { return variable.second.empty(); });
  std::vector<std::string> variables = cli::merged_environment(own);
  if (::posix_spawn(&recorder_, words[0].c_str(), nullptr, nullptr, cli::pointers(words).data(),
                    cli::pointers(variables).data()) != 0)
    recorder_ = -1;
}

std::optional<std::string> Box::poll(bool is_driven, double now) {
  if (occasion_ && now >= *occasion_ + (is_driven ? kDelayWhileDriven : kDelay)) {
    occasion_.reset();
    start();
  }
  int status = 0;
  if (recorder_ <= 0 || ::waitpid(recorder_, &status, WNOHANG) == 0)
    return std::nullopt;
  recorder_ = -1;
  if (status != 0)
    return "the last minute was not kept (" + text_ + "): the log says why";
  prune(folder_);
  return text_ + ". The last minute is in " + file_ + ": saphira replay plays it";
}

}  // namespace saphira::console
