#include "drive/whole.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "saphira/base/places.hpp"
#include "saphira/intentions/activity_folders.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira::test {
namespace {

DriveOptions drive_options(const WholeOptions& options) {
  maps::Map map;
  if (options.made_map)
    map = *options.made_map;
  else if (options.map != "none")
    map =
        maps::load_map(find_file(config_folder() + "/maps",
                                 options.map.empty() ? options.drive.world : options.map, ".map"));
  DriveOptions drive = registered_on(std::move(map), options.drive, options.knows_pose);
  drive.registration->add_features = options.adds_objects;
  drive.registration->snap = options.snap;
  drive.intentions.emplace();
  drive.intentions->registry = options.schemas.value_or(
      shipped_schemas(options.drive.behaviors.value_or(behaviors::predefined())));
  drive.intentions->functions = intentions::all_functions();
  return drive;
}

}  // namespace

intentions::Registry shipped_schemas(const behaviors::Registry& behaviors) {
  intentions::Registry registry = intentions::built_in();
  registry.know_behaviors(system::signatures_of(behaviors));
  const intentions::ActivityFolders::News news =
      intentions::ActivityFolders({intentions::activities_folder()}, intentions::all_functions(),
                                  registry)
          .look();
  if (!news.errors.empty())
    throw std::runtime_error(news.errors.front());
  for (const intentions::Schema& schema : news.taken)
    registry.add(schema);
  return registry;
}

Whole::Whole(const WholeOptions& options) : drive_(drive_options(options)), sees_(options.sees) {}

void Whole::advance() {
  drive_.advance();
  if (!drive_.output().trouble.empty())
    trouble_ = drive_.output().trouble;
  for (const intentions::GoalStatus& status : intentions().news.changed)
    statuses_[status.id] = status;
  for (const intentions::Said& each : intentions().said)
    said_.push_back(each.text);
  if (sees_)
    drive_.cores().see(sees_(drive_));
  note_transitions();
}

bool Whole::advance_until(const std::function<bool()>& done, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    if (done())
      return true;
    advance();
  }
  return done();
}

intentions::GoalId Whole::ask(std::string functor, saphira::Arguments arguments, int priority,
                              double deadline) {
  intentions::GoalEvent event;
  event.goal.id = {1, next_goal_++};
  event.goal.requester = "test";
  event.goal.functor = std::move(functor);
  event.goal.arguments = std::move(arguments);
  event.goal.priority = priority;
  event.goal.deadline = deadline;
  drive_.cores().hear(event);
  return event.goal.id;
}

void Whole::claim(std::string name, intentions::Value value) {
  intentions::ClaimEvent event;
  event.id = {2, next_goal_++};
  event.source = "test";
  event.name = std::move(name);
  event.value = std::move(value);
  drive_.cores().hear(std::move(event));
}

const intentions::GoalStatus& Whole::status(const intentions::GoalId& goal) const {
  static const intentions::GoalStatus unheard;
  const auto found = statuses_.find(goal);
  return found == statuses_.end() ? unheard : found->second;
}

bool Whole::ended(const intentions::GoalId& goal) const {
  return intentions::ended(status(goal).state);
}

intentions::GoalStatus Whole::achieve(std::string functor, saphira::Arguments arguments,
                                      int cycles) {
  const intentions::GoalId goal = ask(std::move(functor), std::move(arguments));
  advance_until([&] { return ended(goal); }, cycles);
  return status(goal);
}

bool Whole::at_rest() const {
  return std::abs(drive_.seen().velocity) < 0.02 &&
         std::abs(drive_.seen().rotation_velocity) < radians(3.0);
}

/// The display of paper Figure 10, as it changes: nodes that come, that come to another state or
/// label, and that go. Names that the forest has generated (I and a number) are in it, too.
void Whole::note_transitions() {
  using intentions::IntentionNode;
  const auto line = [&](const IntentionNode& node, const std::string& what) {
    transitions_.push_back(std::to_string(cycle()) + " " + node.schema + " (" + node.name + ") " +
                           what);
  };
  std::map<std::uint32_t, IntentionNode> now;
  for (const IntentionNode& node : intentions().nodes)
    now.emplace(node.id, node);
  for (const auto& [id, node] : nodes_)
    if (!now.contains(id))
      line(node, "gone");
  for (const auto& [id, node] : now) {
    const auto before = nodes_.find(id);
    if (before == nodes_.end())
      line(node, "begins, " + node.label);
    else if (before->second.label != node.label)
      line(node, node.label);
  }
  nodes_ = std::move(now);
}

}  // namespace saphira::test
