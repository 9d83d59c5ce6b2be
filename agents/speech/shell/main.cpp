#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "saphira/base/format.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/speech/reading.hpp"
#include "speech/shell/speech_shell.hpp"

namespace {

using namespace saphira;

void write_sound(const std::filesystem::path& path, const speech::Sound& sound) {
  std::ofstream out(path, std::ios::binary);
  out << speech::wav(sound) << std::flush;
  if (!out)
    throw UnusableFile(cannot_be(path, "written"));
}

/// A file for each line, and one for all.
void read_aloud(const std::string& dialogue, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<speech::Passage> passages;
  try {
    passages = speech::read_aloud(read_file(dialogue));
  } catch (const std::invalid_argument& error) {
    throw UnusableFile(dialogue + ": " + error.what());
  }
  std::size_t number = 0;
  for (const speech::Passage& passage : passages) {
    write_sound(folder / (format("%03zu-", ++number) + passage.speaker + ".wav"), passage.sound);
  }
  write_sound(folder / "dialogue.wav", speech::joined(passages));
}

}  // namespace

int main(int argc, char** argv) {
  speech::SpeechOptions speech;
  std::string dialogue;
  speech.grammar = "flakey";
  return bus::run_program(
      argc, argv, "speech", "Hears what people say to the robot, and speaks for it",
      [&](CommandLine& app) {
        app.add_option("--grammar", speech.grammar,
                       "what people may say: a name of config/grammars, or a file");
        app.add_option("--pronunciations", speech.pronunciations,
                       "a file: how words sound, where not as in the dictionary");
        app.add_option("--microphone", speech.microphone,
                       "a device of ALSA (arecord -L), a WAV file, a FIFO or - with raw samples "
                       "(16 bits, 16 kHz), or none");
        app.add_option("--speaker", speech.speaker,
                       "a device of ALSA (aplay -L), a folder for WAV files, or none");
        app.add_option("--voice", speech.voice, "slt, rms, awb, kal16, or espeak:NAME");
        app.add_option("--person", speech.person, "the name of whoever speaks, where it is known");
        app.add_option("--read", dialogue,
                       "a file with a line \"speaker: text\" for each that speaks: writes it into "
                       "the folder --speaker as WAV files, and ends")
            .existing_file()
            .needs(app.option("--speaker"));
      },
      [&](const bus::NodeOptions& options, const bus::Stop& stop) {
        if (!dialogue.empty()) {
          read_aloud(dialogue, speech.speaker);
          return bus::kExitOk;
        }
        speech.grammar = find_file(config_folder() + "/grammars", speech.grammar, ".grammar");
        if (speech.pronunciations.empty())
          speech.pronunciations = config_folder() + "/speech/pronunciations.dict";
        if (options.dry_run)
          for (const std::string& trouble : {speech::microphone_trouble(speech.microphone),
                                             speech::speaker_trouble(speech.speaker)})
            if (!trouble.empty())
              std::fprintf(stderr, "%s\n", trouble.c_str());
        bus::Node node(options);
        speech::SpeechShell(node, speech).run(stop);
        return bus::kExitOk;
      });
}
