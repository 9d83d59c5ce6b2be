#include "saphira/logs/log_map.hpp"

#include <stdexcept>

#include "saphira/base/text.hpp"
#include "saphira/logs/laser_map.hpp"

namespace saphira::logs {

LogMap map_log(const DataSet& log, const std::function<bool()>& goes_on) {
  if (log.scans.empty())
    throw UnusableFile(log.name + ": it has no laser scan");
  ScanMapper mapper;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    mapper.add(log.poses_in_odom[i], log.scans[i]);
    if (!goes_on())
      throw std::runtime_error("interrupted");
  }
  mapper.refine(2);
  return {walls_of(mapper.node_scans(), mapper.nodes()), mapper.trajectory(), mapper.report()};
}

}  // namespace saphira::logs
