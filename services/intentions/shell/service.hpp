#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "intentions/shell/memory_file.hpp"
#include "saphira/bus/held.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/intentions/activity_folders.hpp"
#include "saphira/intentions/core.hpp"
#include "saphira/runtime/component.hpp"

namespace saphira::intentions {

struct Options {
  std::string memory_file;  ///< the memory over a restart; empty: none
  /// True where there is a registration service: in lockstep its samples are awaited. Without it,
  /// activities have no map.
  bool registration = true;
  /// The same for interpretation. Without it, activities know only the map's doors and corridors.
  bool interpretation = true;
  /// True where there is a vision service whose samples are awaited in lockstep. Live, it is used
  /// without this option, as soon as it is there.
  bool vision = false;
  /// Activities that cover shipped ones of the same name; empty: none.
  std::string folder;
  std::vector<std::string> approval;  ///< Core::Settings
};

runtime::Component component();

/// The intentions service on the bus.
class Service final : public runtime::Service {
 public:
  /// std::runtime_error where the memory file cannot be written.
  Service(runtime::Ports& ports, const Options& options);

  ProcessTable& processes() override { return core_->processes(); }
  std::optional<std::string> ask(const std::string& name, ProcessAction action,
                                 std::uint32_t cycles) override {
    return core_->ask(name, action, cycles);
  }
  void step(const runtime::Turn& turn) override;
  void between(double silence) override;
  void check_files() override;
  std::string save() const override { return saved(*core_); }
  void restore(std::string_view state) override;

 private:
  std::string missing();
  void step_between(const Core::Received& received, double silence = 0.0);
  std::optional<std::vector<BehaviorSignature>> new_behaviors();
  void learn_behaviors();
  void tell_activities();
  void take_maps();
  void take_goals(Core::Received& received);
  void take_claims(Core::Received& received);
  void take_grants(Core::Received& received);
  Core::Inputs inputs_of(const runtime::Turn& turn);
  std::optional<Core::Vision> vision();
  /// To the disk, before it is published: nothing reported or done is done again.
  void remember(const GoalUpdates& updates);
  void publish(const GoalUpdates& updates);
  void say(const Notes& notes, const std::vector<v1::AuditEntry>& audit);
  void publish(const Core::Outputs& said);
  void draw_way(const std::vector<Vec2>& way);

  runtime::Ports& ports_;
  bus::Input<v1::BehaviorSet>& behaviors_;
  bus::Input<v1::Registration>* registration_;  ///< null where there is no such service
  bus::Input<v1::Perception>* perception_;
  bus::Input<v1::Vision>* vision_;
  std::optional<bus::Reader<v1::Vision>> unasked_vision_;
  std::optional<v1::Vision> newest_vision_;
  bus::Held<v1::FloorMap> maps_;
  bus::Reader<v1::BehaviorSchemas> behavior_schemas_;
  bus::Reader<v1::BeliefClaim> claims_;
  bus::Reader<v1::Goal> goals_;
  bus::Reader<v1::Grant> grants_;
  runtime::Output<v1::Intentions> intentions_;
  runtime::Output<v1::Intentions> recall_;
  runtime::Output<v1::GoalStatusSet> goal_recall_;
  runtime::Output<v1::GoalStatus> statuses_;
  runtime::Output<v1::ActivitySchemas> schemas_;
  runtime::Output<v1::BeliefSet> beliefs_;
  runtime::Output<v1::Message> messages_;
  runtime::Output<v1::Drawing> drawings_;
  runtime::Output<v1::AuditEntry> audit_;
  runtime::Asker map_requests_;
  runtime::Asker servo_;
  runtime::Asker stops_;
  std::uint64_t next_stop_ = bus::next_request_number();
  bool robot_turns_head_ = false;
  bus::RequestClient agents_;
  std::vector<std::pair<std::uint64_t, Answer>> answers_;  ///< since the last step
  std::uint64_t steps_ = 0;
  std::map<GoalId, v1::GoalStatus> told_;  ///< the content of goals/status
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  MemoryFile memory_;
  std::shared_ptr<const Functions> functions_;
  ActivityFolders folders_;
  Core::Settings settings_;
  std::optional<Core> core_;
  bool knows_behaviors_ = false;
  std::vector<Core::NewMap> new_maps_;         ///< since the last step
  std::optional<std::uint64_t> map_revision_;  ///< of the newest map
  lps::LpsSettings robot_;                     ///< of this epoch
};

}  // namespace saphira::intentions
