#include "interpretation/shell/service.hpp"

int main(int argc, char** argv) {
  return saphira::runtime::run_component(argc, argv, saphira::interpretation::component());
}
