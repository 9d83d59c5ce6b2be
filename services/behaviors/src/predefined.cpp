#include "saphira/behaviors/folder.hpp"

namespace saphira::behaviors {

Registry predefined() {
  static const Registry shipped = load_behaviors(behaviors_folder());
  return shipped;
}

}  // namespace saphira::behaviors
