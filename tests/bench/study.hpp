#pragma once

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "support/quantile.hpp"

/// The common parts of the benchmarks: counts of many runs, and figures.
namespace saphira::bench {

/// Prints the figures of a benchmark: on one line for programs (--json), else one below the other.
inline void print(const nlohmann::json& figures, bool json) {
  std::puts(figures.dump(json ? -1 : 2).c_str());
}

/// The counts and measurements of a run or of many, by name.
struct Tally {
  std::map<std::string, long> counts;
  std::map<std::string, std::vector<double>> values;

  long& operator[](const std::string& name) { return counts[name]; }
  long operator()(const std::string& name) const {
    const auto found = counts.find(name);
    return found == counts.end() ? 0 : found->second;
  }
  /// `empty`: without any.
  double share(const std::string& part, const std::string& whole, double empty = 0.0) const {
    return (*this)(whole) > 0
               ? static_cast<double>((*this)(part)) / static_cast<double>((*this)(whole))
               : empty;
  }
  double quantile(const std::string& name, double share) const {
    const auto found = values.find(name);
    return test::quantile(found == values.end() ? std::vector<double>() : found->second, share);
  }
  double sum(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? 0.0
                                 : std::accumulate(found->second.begin(), found->second.end(), 0.0);
  }
  void add(const Tally& other) {
    for (const auto& [name, count] : other.counts)
      counts[name] += count;
    for (const auto& [name, more] : other.values)
      values[name].insert(values[name].end(), more.begin(), more.end());
  }
};

}  // namespace saphira::bench
