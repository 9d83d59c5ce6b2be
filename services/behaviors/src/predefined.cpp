#include "saphira/behaviors/folder.hpp"

namespace saphira::behaviors {

Registry predefined() {
  static const Registry kShipped = load_behaviors(behaviors_folder());
  return kShipped;
}

}  // namespace saphira::behaviors
