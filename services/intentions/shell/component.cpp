#include <memory>

#include "intentions/shell/service.hpp"
#include "saphira/command_line/command_line.hpp"

namespace saphira::intentions {

runtime::Component component() {
  const auto options = std::make_shared<Options>();
  return {"intentions", "Takes goals from anybody on the bus and intends what they need",
          [options](CommandLine& app) {
            app.add_option(
                "--memory", options->memory_file,
                "file that remembers ended goals over a restart, so that none is done twice");
            app.add_flag("!--no-registration", options->registration,
                         "there is no registration service: do not wait for it in lockstep");
            app.add_flag("!--no-interpretation", options->interpretation,
                         "the same of interpretation");
            app.add_flag("--vision", options->vision,
                         "there is a vision service: wait for it in lockstep");
            app.add_option("--activities", options->folder,
                           "folder of activity files; they cover shipped ones of the same name");
            app.add_option(
                   "--approval", options->approval,
                   "role, or beginning of an asker's name such as \"language model\": its goals "
                   "wait until a person approves them (saphira goal approve)")
                .one_value_each();
          },
          [options](runtime::Ports& ports) { return std::make_unique<Service>(ports, *options); }};
}

}  // namespace saphira::intentions
