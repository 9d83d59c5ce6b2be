#include "agent_interface/shell/dialogue_shell.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  agent_interface::DialogueOptions dialogue;
  dialogue.grammar = "flakey";
  return bus::run_program(
      argc, argv, "dialogue", "Understands what people say to the robot, and answers",
      [&](CommandLine& app) {
        app.add_option("--grammar", dialogue.grammar,
                       "what people may say: a name of config/grammars, or a file");
        app.add_option("--memory", dialogue.memory, "a file that keeps the robot's knowledge");
      },
      [&](const bus::NodeOptions& options, const bus::Stop& stop) {
        dialogue.grammar = find_file(config_folder() + "/grammars", dialogue.grammar, ".grammar");
        bus::Node node(options);
        do
          agent_interface::DialogueShell(node, dialogue).run(stop);
        while (!stop.requested());
        return bus::kExitOk;
      });
}
