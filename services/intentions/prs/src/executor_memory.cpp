#include <utility>

#include "forest_node.hpp"
#include "saphira/intentions/executor.hpp"

// The goals over a restart of the service.
namespace saphira::intentions {
namespace {

/// The longest wait for the place of the robot, after a restart.
constexpr Ticks kFindsPlace = 50;

}  // namespace

void Executor::archive(Archive& a) {
  a("beliefs", *beliefs_)("entries", entries_)("set_revision", set_revision_)("endings", endings_)(
      "ended_order", ended_order_)("next_order", next_order_)("now", now_)("awake", awake_)(
      "epoch", epoch_)("cycle", cycle_)("robot_here", robot_here_)("on_map", on_map_)(
      "place_by", place_by_)("person", person_)("stops", stops_)("odom", odom_)("withdrawn",
                                                                                withdrawn_);
  if (a.restores())
    for (auto& [id, entry] : entries_) {
      entry.schema = registry_->share(entry.goal.functor);
      a.expect(entry.schema || !entry.open(), "no activity " + entry.goal.functor);
    }
  struct InForest {
    Executor& self;
    void archive(Archive& in) {
      self.forest_.archive(in, [&](std::uint32_t root) {
        for (const auto& [id, entry] : self.entries_)
          if (entry.node == root && entry.schema)
            return entry.schema->make(entry.arguments);
        in.fail("a goal for each tree");
      });
    }
  } forest{*this};
  a("forest", forest);
}

/// That activities have set, without those that end with an intention: they are saved with it.
std::vector<Belief> Executor::lasting_beliefs() const {
  std::vector<Belief> beliefs = beliefs_->set_by_activities();
  std::erase_if(beliefs, [&](const Belief& belief) {
    return normal(belief.name) == kBehaviorControl || forest_.ends_with_intention(belief.name);
  });
  return beliefs;
}

std::optional<Work> Executor::work() {
  if (!options_.remembers_work || !odom_)
    return std::nullopt;
  Work work{.epoch = epoch_,
            .cycle = cycle_,
            .odom = *odom_,
            .now = now_,
            .awake = awake_,
            .last_intention = forest_.last_id(),
            .beliefs = lasting_beliefs(),
            .heeds = stops_.heeds(),
            .placed = on_map_ || awake_ < place_by_,
            .ended = endings_.newest()};
  for (const auto& [id, entry] : entries_) {
    if (!entry.open())
      continue;
    Entry& saved = work.goals[id] = entry;
    saved.published.reset();
    if (entry.node != 0)
      saved.tree = forest_.save(entry.node);
  }
  return work;
}

void Executor::recall(const Work& work) {
  stops_ = Stops(work.heeds);
  epoch_ = work.epoch;
  cycle_ = work.cycle;
  odom_ = work.odom;
  now_ = work.now;
  awake_ = work.awake;
  if (work.placed)
    place_by_ = awake_ + kFindsPlace;
  forest_.begin_after(work.last_intention, awake_);
  for (const Belief& belief : work.beliefs)
    beliefs_->set(belief.name, belief.value, belief.said_by, belief.since);
  for (const auto& [id, known] : work.goals) {
    next_order_ = std::max(next_order_, known.order + 1);
    if (endings_.find(id) == nullptr)
      recall(entries_[id] = known);
  }
}

void Executor::recall(Entry& entry) {
  const std::uint32_t root = std::exchange(entry.node, 0);
  const Saved tree = std::exchange(entry.tree, {});
  entry.schema = registry_->share(entry.goal.functor);
  entry.before = true;
  entry.requester.recall(awake_);
  Arguments complete;
  if (!entry.schema || !check_arguments(*entry.schema, entry.arguments, complete).empty()) {
    end(entry, v1::GOAL_FAILED, v1::CODE_UNKNOWN_FUNCTOR,
        "intentions was restarted, and its activity is another now: ask again");
    return;
  }
  try {
    if (root != 0) {
      forest_.restore(root, tree,
                      [&](std::uint32_t) { return entry.schema->make(entry.arguments); });
      entry.node = root;
    }
  } catch (const std::runtime_error& error) {
    // A built-in only needs its arguments, which are places and headings.
    if (entry.schema->program)
      entry.status.note =
          std::string("was begun anew at its first step: intentions was restarted, and ") +
          error.what();
  }
  lose_robot(entry, {});
}

}  // namespace saphira::intentions
