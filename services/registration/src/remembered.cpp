#include "saphira/registration/remembered.hpp"

#include "saphira/base/durable.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/maps/edit.hpp"

namespace saphira::registration {
namespace {

constexpr std::string_view kMapFollows = "\nmap\n";
constexpr long kMostOdom = 1L << 53;  // the whole numbers of a double
constexpr long kMostId = 2147483647;

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

/// Blanks, semicolons and line breaks as %20: one word for any name. Empty for an empty name.
std::string to_word(const std::string& name) {
  std::string word;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > 0x20 && byte != 0x7F && c != ';' && c != '%') {
      word += c;
      continue;
    }
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", byte);
    word += code;
  }
  return word;
}

std::string read_name(LineReader& reader) {
  if (reader.at_end())
    return "";
  const std::string_view word = reader.word("a name");
  std::string name;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i] != '%') {
      name += word[i];
      continue;
    }
    const std::string_view code = word.substr(i + 1, 2);
    const auto byte = number_in<unsigned>(code, 16);
    if (code.size() != 2 || !byte)
      reader.fail("expected two hexadecimal digits after %");
    name += static_cast<char>(*byte);
    i += 2;
  }
  return name;
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
  text += "option " + to_word(remembered.option) + "\n";
  text += "source " + to_word(remembered.source) + "\n";
  text += "changed " + std::string(remembered.changed ? "1" : "0") + "\nclosed";
  for (const std::uint32_t door : remembered.closed_doors)
    text += " " + std::to_string(door);
  // A map file does not contain this flag.
  text += "\nlearned";
  for (std::size_t i = 0; i < remembered.map.features.size(); ++i)
    if (remembered.map.features[i].learned)
      text += " " + std::to_string(i);
  return sealed(text + std::string(kMapFollows) + maps::to_text(remembered.map));
}

Remembered parse_remembered(std::string_view sealed_text, const std::string& file) {
  const std::string_view text = unsealed(sealed_text, file);
  const std::size_t end = text.find(kMapFollows);
  const std::vector<Line> lines = split_lines(text.substr(0, end));
  Remembered result;
  Memory& memory = result.memory;
  std::vector<std::size_t> learned;
  for (const Line& line : lines) {
    LineReader reader(file, line);
    const std::string_view word = reader.word("what the line says");
    if (word == "odom") {
      memory.odom = static_cast<decltype(memory.odom)>(
          reader.integer("the number of the odom frame", 0, kMostOdom));
    } else if (word == "placed") {
      memory.placed = reader.integer("0 or 1", 0, 1) == 1;
    } else if (word == "pose_in_odom") {
      memory.pose_in_odom = read_pose(reader);
    } else if (word == "pose_in_map") {
      memory.pose_in_map = read_pose(reader);
      if (const auto why = maps::problem(memory.pose_in_map))
        reader.fail(*why);
    } else if (word == "covariance") {
      for (Eigen::Index i = 0; i < 16; ++i)
        memory.covariance.data()[i] = reader.number("a variance");
    } else if (word == "drift") {
      memory.drift = reader.number("the drift [rad/m]");
    } else if (word == "confidence") {
      memory.confidence = reader.number("the confidence", 0.0, 1.0);
    } else if (word == "source") {
      result.source = read_name(reader);
    } else if (word == "option") {
      result.option = read_name(reader);
    } else if (word == "changed") {
      result.changed = reader.integer("0 or 1", 0, 1) == 1;
    } else if (word == "closed") {
      while (!reader.at_end())
        result.closed_doors.insert(
            static_cast<std::uint32_t>(reader.integer("the id of a door", 1, kMostId)));
    } else if (word == "learned") {
      while (!reader.at_end())
        learned.push_back(
            static_cast<std::size_t>(reader.integer("which artifact of the map", 0, kMostId)));
    } else {
      reader.fail(
          "expected one of odom, placed, pose_in_odom, pose_in_map, covariance, drift, "
          "confidence, option, source, changed, closed, learned");
    }
    reader.expect_end();
  }
  if (end == std::string_view::npos) {
    const Line last = lines.empty() ? Line{} : lines.back();
    throw FileError(file, last.number, 1, "expected a line \"map\", and the map after it",
                    last.text);
  }
  result.map = maps::parse_map(text.substr(end + kMapFollows.size()), file);
  for (const std::size_t index : learned)
    if (index < result.map.features.size())
      result.map.features[index].learned = true;
  return result;
}

}  // namespace saphira::registration
