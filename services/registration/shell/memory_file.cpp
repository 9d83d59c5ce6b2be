#include "registration/shell/memory_file.hpp"

#include <filesystem>
#include <fstream>

#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::registration {
namespace {

constexpr std::string_view kMapFollows = "\nmap\n";

std::string write(const char* word, const double* values, std::size_t count) {
  std::string line = word;
  for (std::size_t i = 0; i < count; ++i)
    line += " " + exact(values[i]);
  return line + "\n";
}

std::string write(const char* word, const Pose& pose) {
  const double values[] = {pose.x, pose.y, pose.th};
  return write(word, values, 3);
}

Pose read_pose(LineReader& reader) {
  Pose pose;
  pose.x = reader.number("x");
  pose.y = reader.number("y");
  pose.th = reader.number("theta");
  return pose;
}

}  // namespace

std::string to_text(const Remembered& remembered) {
  const Memory& memory = remembered.memory;
  std::string text =
      "; What registration knew last. Written by the service; to begin anew, delete it.\n";
  text += "odom " + std::to_string(memory.odom) + "\n";
  text += "placed " + std::string(memory.placed ? "1" : "0") + "\n";
  text += write("pose_in_odom", memory.pose_in_odom);
  text += write("pose_in_map", memory.pose_in_map);
  text += write("covariance", memory.covariance.data(), 16);
  text += write("drift", &memory.drift, 1);
  text += write("confidence", &memory.confidence, 1);
  text += "source " + remembered.source;
  return text + std::string(kMapFollows) + maps::to_text(remembered.map);
}

Remembered parse_remembered(std::string_view text, const std::string& file) {
  const std::size_t end = text.find(kMapFollows);
  const std::vector<Line> lines = split_lines(text.substr(0, end));
  Remembered result;
  Memory& memory = result.memory;
  for (const Line& line : lines) {
    LineReader reader(file, line);
    const std::string_view word = reader.word("what the line says");
    if (word == "odom") {
      memory.odom = static_cast<decltype(memory.odom)>(
          std::stoull(std::string(reader.word("the number of the odom frame"))));
    } else if (word == "placed") {
      memory.placed = reader.integer("0 or 1", 0, 1) == 1;
    } else if (word == "pose_in_odom") {
      memory.pose_in_odom = read_pose(reader);
    } else if (word == "pose_in_map") {
      memory.pose_in_map = read_pose(reader);
    } else if (word == "covariance") {
      for (Eigen::Index i = 0; i < 16; ++i)
        memory.covariance.data()[i] = reader.number("a variance");
    } else if (word == "drift") {
      memory.drift = reader.number("the drift [rad/m]");
    } else if (word == "confidence") {
      memory.confidence = reader.number("the confidence", 0.0, 1.0);
    } else if (word == "source") {
      // The rest of the line: a path may have blanks.
      while (!reader.at_end())
        result.source += (result.source.empty() ? "" : " ") + std::string(reader.word("a path"));
    } else {
      reader.fail(
          "expected one of odom, placed, pose_in_odom, pose_in_map, covariance, drift, "
          "confidence, source");
    }
    reader.expect_end();
  }
  if (end == std::string_view::npos) {
    const Line last = lines.empty() ? Line{} : lines.back();
    throw FileError(file, last.number, 1, "expected a line \"map\", and the map after it",
                    last.text);
  }
  result.map = maps::parse_map(text.substr(end + kMapFollows.size()), file);
  return result;
}

std::optional<Remembered> load_remembered(const std::string& path) {
  if (!std::filesystem::exists(path))
    return std::nullopt;
  return parse_remembered(read_file(path), path);
}

bool save_remembered(const std::string& path, const Remembered& remembered) {
  const std::string fresh = path + ".new";
  {
    std::ofstream file(fresh, std::ios::trunc);
    file << to_text(remembered);
    if (!file.flush())
      return false;
  }
  return std::rename(fresh.c_str(), path.c_str()) == 0;
}

}  // namespace saphira::registration
