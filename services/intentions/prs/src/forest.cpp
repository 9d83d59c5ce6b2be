#include "saphira/intentions/forest.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

#include "forest_handle.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {

static constexpr std::size_t kMostQuestions = 64;  // in a cycle
namespace {

/// Of a behavior without its own priority, as in the manual's example (8.1.2).
constexpr int kUsualPriority = 2;

Ticks ticks(double seconds) {
  return seconds > 0.0 ? std::max<Ticks>(1, std::llround(seconds / kTick)) : 0;
}

constexpr std::size_t kManyWords = 40;  ///< letters of a value; a longer one is cut

std::string in_words(const Bindings& arguments, const World& world) {
  std::string text;
  for (const auto& [name, value] : arguments) {
    std::string words = value.list().empty() ? name_of(world, value)
                                             : std::to_string(value.list().size()) + " values";
    if (words.size() > kManyWords) {
      std::size_t end = kManyWords - 3;
      while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0U) == 0x80U)
        --end;  // not within a character of several bytes
      words = words.substr(0, end) + "...";
    }
    if (!text.empty())
      text += ", ";
    text += name;
    text += "=";
    text += words;
  }
  return text;
}

}  // namespace

Forest::Forest(std::shared_ptr<const Registry> registry, std::shared_ptr<Beliefs> beliefs,
               ForestOptions options)
    : registry_(registry ? std::move(registry) : std::make_shared<const Registry>()),
      beliefs_(beliefs ? std::move(beliefs) : std::make_shared<Beliefs>()),
      options_(options) {}
Forest::~Forest() = default;
Forest::Forest(Forest&&) noexcept = default;
Forest& Forest::operator=(Forest&&) noexcept = default;

Forest::Node* Forest::at(std::uint32_t id) const {
  const auto found = nodes_.find(id);
  return found == nodes_.end() ? nullptr : found->second.get();
}

std::uint32_t Forest::plant(const GoalId& goal, std::string_view name, std::string_view schema,
                            std::unique_ptr<Activity> activity, int priority, double timeout,
                            bool concurrent) {
  auto node = std::make_unique<Node>();
  const std::uint32_t id = ++last_id_;
  node->shown.id = id;
  node->shown.name = name;
  node->shown.schema = schema;
  node->shown.goal = goal;
  node->shown.priority = priority;
  node->shown.since = now_;
  node->root = id;
  node->begun = now_;
  node->timeout = ticks(timeout);
  node->concurrent = concurrent;
  node->activity = std::move(activity);
  nodes_.emplace(id, std::move(node));
  roots_.push_back(id);
  order_is_old_ = true;
  changed_ = true;
  return id;
}

Forest::Node& Forest::add(Node& parent, std::string_view name, std::string_view schema,
                          bool blocking) {
  auto node = std::make_unique<Node>();
  const std::uint32_t id = ++last_id_;
  node->shown.id = id;
  node->shown.parent = parent.shown.id;
  node->shown.name = name;
  node->shown.schema = schema;
  node->shown.goal = parent.shown.goal;
  node->shown.blocking = blocking;
  node->shown.priority = parent.shown.priority;
  node->shown.since = now_;
  node->root = parent.root;
  node->depth = parent.depth + 1;
  node->concurrent = parent.concurrent;
  parent.children.push_back(id);
  order_is_old_ = true;
  changed_ = true;
  return *nodes_.emplace(id, std::move(node)).first->second;
}

std::uint32_t Forest::start(Node& parent, const Start& start, const World& world) {
  if (nodes_.size() >= options_.max_intentions)
    throw ActivityError("there are " + std::to_string(nodes_.size()) +
                        " intentions already: does an activity begin others without end?");
  if (parent.children.size() >= options_.max_children)
    throw ActivityError(parent.shown.schema + " has begun " +
                        std::to_string(parent.children.size()) + " intentions already");
  if (parent.depth >= options_.max_depth)
    throw ActivityError("intentions stand within each other " + std::to_string(options_.max_depth) +
                        " deep");
  const std::shared_ptr<const Schema> schema = registry_->intended(start.schema);
  std::unique_ptr<Activity> activity;
  if (schema)
    activity = instantiate(*schema, start.arguments, world.robot);
  Node& child =
      add(parent, start.name, schema ? schema->name : std::string(start.schema), start.blocking);
  const std::uint32_t id = child.shown.id;
  child.given = fixed_in_odom(start.arguments, world.robot);
  if (start.name.empty())
    child.shown.name = "I" + std::to_string(id);
  child.timeout = start.timeout > 0 || !schema ? start.timeout : ticks(schema->timeout);
  child.begun = world.now;
  if (!activity) {
    try {
      make_behavior(child, start, world);
    } catch (...) {
      drop(id);
      throw;
    }
    return id;
  }
  child.activity = std::move(activity);
  child.shown.arguments = in_words(start.arguments, world);
  child.shown.priority =
      start.priority.value_or(schema->priority != 0 ? schema->priority : parent.shown.priority);
  to_begin_.push_back(id);
  return id;
}

void Forest::make_behavior(Node& node, const Start& start, const World& world) {
  if (node.concurrent)
    throw ActivityError(kMustNotDrive);
  const BehaviorSignature* const known = registry_->behavior(start.schema);
  if (known == nullptr && registry_->knows_behaviors())
    throw ActivityError("there is neither an activity nor a behavior " +
                        quoted(std::string(start.schema)));
  const auto others = std::count_if(nodes_.begin(), nodes_.end(), [](const auto& each) {
    return !each.second->activity && !finished(each.second->shown.state);
  });
  if (static_cast<std::size_t>(others) > options_.max_behaviors)
    throw ActivityError("there are " + std::to_string(options_.max_behaviors) +
                        " behaviors already: does an activity begin others without end?");
  node.behavior.schema = registry_->behavior_name(start.schema);
  node.shown.schema = node.behavior.schema;
  node.shown.label = "B";
  node.shown.state = IntentionState::kRunning;
  node.behavior.name = (start.name.empty() ? node.behavior.schema : std::string(start.name)) + "#" +
                       std::to_string(node.shown.id);
  node.behavior.intention = node.shown.id;
  node.behavior.blocking = start.blocking;
  node.behavior.priority = start.priority.value_or(kUsualPriority);
  node.shown.priority = node.behavior.priority;
  node.until_satisfied = start.until_satisfied;
  node.parameters = BehaviorParameters(start.arguments, node.behavior.schema, known, world);
  node.since = world.now;
  node.level = 0.0;
  if (!node.parameters.place(node.behavior.parameters, world))
    throw ActivityError("the robot does not know where it is on the map", v1::CODE_NO_POSITION);
}

void Forest::interrupt(std::uint32_t id, Hold why) {
  Node& node = *nodes_.at(id);
  node.holds |= static_cast<unsigned>(why);
  changed_ = true;
  if (!node.suspended)
    suspend(node);
}

void Forest::suspend(Node& node) {
  if (finished(node.shown.state))
    return;
  node.suspended = true;
  node.suspended_at = now_;
  // An intention that never began has nothing to clean up.
  const bool put_away = node.activity != nullptr && node.shown.state != IntentionState::kInit;
  node.shown.state = put_away ? IntentionState::kInterrupted : IntentionState::kSuspended;
  if (node.activity == nullptr || !node.activity->keeps_children())
    return;
  for (const std::uint32_t child : node.children) {
    if (!at(child)->suspended)
      suspend(*at(child));
  }
}

void Forest::resume(std::uint32_t id, Hold why) {
  Node& node = *nodes_.at(id);
  node.holds &= ~static_cast<unsigned>(why);
  changed_ = true;
  const Node* const parent = at(node.shown.parent);
  if (node.holds == 0 && (parent == nullptr || !parent->suspended))
    wake(node);
}

void Forest::wake(Node& node) {
  if (!node.suspended || finished(node.shown.state) || node.holds != 0)
    return;
  node.begun += now_ - node.suspended_at;
  node.suspended = false;
  if (!node.activity) {
    node.shown.state = IntentionState::kRunning;
    node.since = now_ + 1;
    node.level = 0.0;
    woken_.push_back(node.shown.id);
    return;
  }
  node.shown.state = IntentionState::kResumed;
  if (!node.activity->keeps_children()) {
    remove_children(node);
    return;
  }
  for (const std::uint32_t child : node.children)
    wake(*at(child));
}

bool Forest::held(std::uint32_t id, Hold why) const {
  const Node* const node = at(id);
  return node != nullptr && (node->holds & static_cast<unsigned>(why)) != 0;
}

void Forest::remove(std::uint32_t id) {
  if (at(id) != nullptr)
    drop(id);
}

void Forest::drop(std::uint32_t id) {
  Node& node = *nodes_.at(id);
  remove_children(node);
  if (Node* const parent = at(node.shown.parent))
    std::erase(parent->children, id);
  else if (node.shown.parent == 0)
    std::erase(roots_, id);
  if (control_off_.erase(id) > 0 && control_off_.empty())
    beliefs_->unset(kBehaviorControl);
  end_beliefs(id);
  order_is_old_ = true;
  changed_ = true;
  node.gone = true;
  const auto found = nodes_.find(id);
  graves_.push_back(std::move(found->second));
  nodes_.erase(found);
}

void Forest::end_beliefs(std::uint32_t id) {
  std::erase_if(whiles_, [&](const auto& one) {
    if (one.second == id)
      beliefs_->unset(one.first);
    return one.second == id;
  });
}

void Forest::remove_children(Node& parent) {
  const std::vector<std::uint32_t> children = std::exchange(parent.children, {});
  for (const std::uint32_t child : children)
    drop(child);
}

Forest::Node* Forest::child_of(const Node& parent, std::string_view label) const {
  for (const std::uint32_t id : parent.children) {
    Node* const child = at(id);
    if (!child->activity && child->label == label)
      return child;
  }
  return nullptr;
}

/// The intention of that name among the descendants of `top`: the nearest first, then the newest;
/// not `seeker` itself.
Forest::Node* Forest::named(const Node& top, std::string_view name, const Node& seeker) const {
  std::deque<const Node*> open = {&top};
  while (!open.empty()) {
    const Node* const node = open.front();
    open.pop_front();
    for (auto id = node->children.rbegin(); id != node->children.rend(); ++id) {
      Node* const child = at(*id);
      if (child != &seeker && !finished(child->shown.state) && normal(child->shown.name) == name)
        return child;
      open.push_back(child);
    }
  }
  return nullptr;
}

void Forest::tell_parent(const Node& node) {
  if (node.shown.parent != 0)
    to_tell_.push_back(node.shown.parent);
}

void Forest::hear(const std::vector<BehaviorLevel>& levels, Ticks tick) {
  for (const BehaviorLevel& level : levels) {
    const std::size_t mark = level.name.rfind('#');
    if (mark == std::string::npos)
      continue;
    std::uint32_t id = 0;
    std::from_chars(level.name.data() + mark + 1, level.name.data() + level.name.size(), id);
    Node* const node = at(id);
    if (node != nullptr && !node->activity && node->behavior.name == level.name &&
        tick > node->since)
      node->level = level.goal;
  }
}

void Forest::hear(const std::vector<v1::MissingBehavior>& troubles) {
  for (const v1::MissingBehavior& trouble : troubles) {
    for (auto& [id, node] : nodes_) {
      if (node->activity || node->behavior.name != trouble.name || node->suspended ||
          finished(node->shown.state))
        continue;
      node->shown.state = IntentionState::kFailure;
      node->outcome = {IntentionState::kFailure, v1::CODE_ACTIVITY, trouble.reason};
      Node& parent = *at(node->shown.parent);
      if (!parent.suspended && !parent.activity->waits_for(id))
        parent.trouble = node->behavior.schema + ": " + trouble.reason;
    }
  }
}

/// A behavior is an intention that monitors it (manual 8.5).
void Forest::watch(Node& node, const World& world) {
  if (node.suspended || node.shown.state != IntentionState::kRunning)
    return;
  node.parameters.place(node.behavior.parameters, world);
  if (node.until_satisfied && node.level.value_or(0.0) >= kSatisfied) {
    changed_ = true;
    node.shown.state = IntentionState::kSuccess;
    node.outcome = {IntentionState::kSuccess, v1::CODE_NONE, "satisfied"};
  } else if (node.timeout > 0 && world.now - node.begun >= node.timeout) {
    node.shown.state = IntentionState::kTimeout;
    node.outcome = {IntentionState::kTimeout, v1::CODE_TIMEOUT,
                    "not satisfied in " + plain(in_seconds(node.timeout)) + " s"};
  }
}

void Forest::step(Ticks now, const Robot& robot) {
  const Surroundings nothing;
  step(World{robot, nothing, *beliefs_, now});
}

void Forest::step(const World& world) {
  now_ = world.now;
  begun_ = 0;
  graves_.clear();
  if (std::exchange(order_is_old_, false))
    sort();
  for (Node* const node : behaviors_)
    watch(*node, world);
  // New intentions of the step are not in the order yet; ended ones are marked.
  for (Node* const node : order_) {
    if (!node->gone)
      step_one(*node, world);
  }
  work_off(world);
  end_cycle(world);
}

void Forest::sort() {
  order_.clear();
  behaviors_.clear();
  for (const auto& [id, node] : nodes_)
    (node->activity ? order_ : behaviors_).push_back(node.get());
  std::stable_sort(order_.begin(), order_.end(), [](const Node* a, const Node* b) {
    return a->shown.priority > b->shown.priority;
  });
}

void Forest::begin(std::uint32_t id, const World& world) {
  Node* const node = at(id);
  if (node != nullptr &&
      (node->stepped != world.now || node->shown.state != IntentionState::kRunning))
    step_one(*node, world);
  work_off(world);
  end_cycle(world);
}

void Forest::step_one(Node& node, const World& world) {
  if (node.shown.state == IntentionState::kSuspended || finished(node.shown.state))
    return;
  const bool interrupted = node.shown.state == IntentionState::kInterrupted;
  node.stepped = world.now;
  Handle handle(*this, node, world);
  try {
    if (node.trouble)
      throw ActivityError(*node.trouble);
    node.activity->step(handle);
  } catch (const ActivityError& error) {
    handle.fail(error.code(), error.what());
  }
  conclude(node, interrupted, world);
}

/// The result of a step of the intention.
void Forest::conclude(Node& node, bool interrupted, const World& world) {
  if (finished(node.outcome.state)) {
    node.shown.state = node.outcome.state;
    node.shown.label = "END";
  } else if (interrupted) {
    node.shown.state = IntentionState::kSuspended;
  } else if (node.timeout > 0 && world.now - node.begun >= node.timeout) {
    node.shown.state = IntentionState::kTimeout;
    node.outcome = {IntentionState::kTimeout, v1::CODE_TIMEOUT,
                    "not done in " + plain(in_seconds(node.timeout)) + " s"};
  } else {
    node.shown.state = IntentionState::kRunning;
  }
  const bool ends = finished(node.shown.state);
  changed_ = changed_ || ends;
  // An intention that does not run leaves nothing running (manual 8.1.4, and rule 3 of 8.4).
  if (ends || (interrupted && !node.activity->keeps_children()))
    remove_children(node);
  if (ends) {
    end_beliefs(node.shown.id);
    tell_parent(node);
  }
  for (const std::uint32_t id : std::exchange(doomed_, {})) {
    if (const Node* const doomed = at(id)) {
      tell_parent(*doomed);
      remove(id);
    }
  }
}

/// Steps new intentions and reports ended ones to their parents, until none are left.
void Forest::work_off(const World& world) {
  while (!to_begin_.empty() || !to_tell_.empty()) {
    if (!to_begin_.empty()) {
      const std::uint32_t id = to_begin_.front();
      to_begin_.pop_front();
      // Beyond the bound it begins in the next step.
      if (begun_ < options_.max_begun) {
        ++begun_;
        if (Node* const node = at(id))
          step_one(*node, world);
      }
      continue;
    }
    const std::uint32_t id = to_tell_.front();
    to_tell_.pop_front();
    Node* const node = at(id);
    if (node == nullptr || !node->activity || node->shown.state != IntentionState::kRunning ||
        node->stepped != world.now)
      continue;
    Handle handle(*this, *node, world);
    node->activity->child_ended(handle);
    conclude(*node, false, world);
  }
}

/// Removes ended roots, and updates behaviors that changed in this cycle after watch().
void Forest::end_cycle(const World& world) {
  for (const std::uint32_t id : std::exchange(woken_, {})) {
    if (Node* const node = at(id))
      node->parameters.place(node->behavior.parameters, world);
  }
  std::vector<std::uint32_t> gone;
  for (const std::uint32_t id : roots_) {
    if (finished(at(id)->shown.state))
      gone.push_back(id);
  }
  for (const std::uint32_t id : gone) {
    ended_[id] = at(id)->outcome;
    drop(id);
  }
}

bool Forest::contains(std::uint32_t id) const {
  return nodes_.contains(id);
}

bool Forest::is_activity(std::uint32_t id) const {
  const Node* const node = at(id);
  return node != nullptr && node->activity != nullptr;
}

bool Forest::ends_with_intention(std::string_view belief) const {
  return whiles_.contains(normal(belief));
}

bool Forest::behavior_control() const {
  return control_off_.empty();
}

std::map<std::uint32_t, Outcome> Forest::take_ended() {
  return std::exchange(ended_, {});
}

std::vector<Request> Forest::take_requests() {
  return std::exchange(requests_, {});
}

std::vector<Request> Forest::take_questions() {
  return std::exchange(questions_, {});
}

/// Numbers follow the tick, so that a question from before a restart differs from a new one.
std::uint64_t Forest::ask(Request request) {
  if (questions_.size() >= kMostQuestions)
    throw ActivityError("more than " + std::to_string(kMostQuestions) + " questions in a cycle");
  request.number = static_cast<std::uint64_t>(now_) * kMostQuestions + questions_.size() + 1;
  questions_.push_back(std::move(request));
  return questions_.back().number;
}

std::vector<SpokenText> Forest::take_said() {
  return std::exchange(said_, {});
}

Activity& Forest::activity(std::uint32_t id) {
  const auto& node = nodes_.at(id);
  assert(node->activity);
  return *node->activity;
}

const IntentionNode& Forest::foremost(std::uint32_t id) const {
  const Node* node = nodes_.at(id).get();
  while (true) {
    const Node* next = nullptr;
    for (const std::uint32_t child : node->children) {
      const Node* const one = at(child);
      if (one != nullptr && one->activity != nullptr && one->shown.blocking &&
          !finished(one->shown.state))
        next = one;
    }
    if (next == nullptr)
      return node->shown;
    node = next;
  }
}

double Forest::progress_of(std::uint32_t id) const {
  return nodes_.at(id)->progress;
}

double Forest::level_of(std::uint32_t id) const {
  return level_of(*nodes_.at(id));
}

double Forest::level_of(const Node& node) {
  return node.shown.state == IntentionState::kSuccess ? 1.0 : node.level.value_or(node.progress);
}

std::vector<IntendedBehavior> Forest::behaviors() const {
  std::vector<IntendedBehavior> all;
  for (const auto& [id, node] : nodes_) {
    if (!node->activity && node->shown.state == IntentionState::kRunning)
      all.push_back(node->behavior);
  }
  return all;
}

std::vector<IntentionNode> Forest::nodes() const {
  std::vector<IntentionNode> all;
  all.reserve(nodes_.size());
  for (const auto& [id, node] : nodes_) {
    all.push_back(node->shown);
    all.back().level = level_of(*node);
  }
  return all;
}

}  // namespace saphira::intentions
