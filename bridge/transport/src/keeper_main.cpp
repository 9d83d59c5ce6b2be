// saphira-keeper: started by saphira-bridge, with the socket to it.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "saphira/transport/keeper.hpp"

int main(int argc, char** argv) {
  const int silence = argc == 2 ? std::atoi(argv[1]) : 0;
  if (silence <= 0) {
    const std::string word = argc == 2 ? argv[1] : "";
    const bool asked = word == "--help" || word == "--version";
    std::fputs(word == "--version"
                   ? "saphira " SAPHIRA_VERSION "\n"
                   : "Stops the robot when the bridge hangs or dies; saphira-bridge starts it\n",
               asked ? stdout : stderr);
    return asked ? 0 : 2;
  }
  saphira::transport::keep(saphira::transport::kKeeperSocket, std::chrono::milliseconds(silence));
}
