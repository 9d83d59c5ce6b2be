// saphira-keeper: started by saphira-bridge, with what it hears the bridge by.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "saphira/transport/keeper.hpp"

int main(int argc, char** argv) {
  const int silence = argc == 2 ? std::atoi(argv[1]) : 0;
  if (silence <= 0) {
    std::fputs("saphira-keeper is started by saphira-bridge, which it keeps\n", stderr);
    return 2;
  }
  saphira::transport::keep(saphira::transport::kKeeperSocket, std::chrono::milliseconds(silence));
}
