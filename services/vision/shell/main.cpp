#include "vision/shell/service.hpp"

int main(int argc, char** argv) {
  return saphira::runtime::run_component(argc, argv, saphira::vision::component());
}
