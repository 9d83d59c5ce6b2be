#include "saphira/agent_interface/tasks.hpp"

#include "saphira/base/archive.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kLongestHold = 600.0;  // [s]
constexpr std::size_t kMostLater = 16;

bool is_stop(const Task& task) {
  return task.goal.functor == "stop";
}

/// "at 05:00 I go home, and then I wait there"
std::string whole_text(const Tasks::Later& later) {
  std::string text = time_text(later.time);
  for (const Task& step : later.steps)
    text += (&step == &later.steps.front() ? "" : ", and then ") + step.what;
  return text;
}

/// Cancels a task, and tells its owner. by: the person for whom it ends.
void cancel(const Task& task, const std::string& by, const std::string& why, Tasks::Outputs& out) {
  out.canceled.push_back(task.goal.tag);
  out.said.push_back({task.answers, task.goal.speaker,
                      "I drop " + named_task(task, by) +
                          (task.then.empty() ? "" : ", and the rest of the order") + why,
                      true});
}

}  // namespace

std::string whole_text(const Task& task) {
  std::string text = task.what;
  for (const Task& step : task.then)
    text += ", and then " + step.what;
  return text;
}

const Task* Tasks::task() const {
  const auto found =
      std::find_if(open_.begin(), open_.end(), [](const Task& one) { return !one.brief; });
  return found == open_.end() ? nullptr : &*found;
}

/// Steps of a sequence go before the hold that stands between them.
int Tasks::priority_of(const Task& next) const {
  const bool interrupts = next.brief && task() != nullptr;
  return !interrupts ? 0 : hold_ == 0 && next.then.empty() ? 1 : 2;
}

std::string Tasks::after_others(const Task& next) const {
  const bool beside = next.goal.functor == "look" || is_stop(next);
  return front_ && !beside && front_->priority >= priority_of(next) ? "after " + front_->name + ", "
                                                                    : std::string();
}

void Tasks::begin(Task task, Outputs& out) {
  const bool interrupts = task.brief && this->task() != nullptr;
  task.waits = !after_others(task).empty();
  if (interrupts && !task.then.empty() && hold_ == 0) {
    hold_ = ++tag_;
    WantedGoal hold{hold_, "pause", {number("seconds", kLongestHold)}};
    hold.speaker = task.goal.speaker;
    hold.person = task.goal.person;
    hold.priority = 1;
    out.goals.push_back(std::move(hold));
  }
  task.goal.tag = ++tag_;
  task.goal.priority = priority_of(task);
  out.goals.push_back(task.goal);
  open_.push_back(std::move(task));
}

void Tasks::release(Outputs& out) {
  if (hold_ != 0)
    out.canceled.push_back(std::exchange(hold_, 0));
}

/// Ends what is open, and tells its owner why.
void Tasks::drop(bool brief, const std::string& by, const std::string& text, Outputs& out) {
  if (brief)
    release(out);
  for (auto one = open_.begin(); one != open_.end();) {
    // A stop ends in a moment; what comes after it waits for that.
    if (one->brief != brief || is_stop(*one)) {
      ++one;
      continue;
    }
    cancel(*one, by,
           same_person(one->goal.speaker, by) ? ""
                                              : ": " + named_person(by) + " said \"" + text + "\"",
           out);
    one = open_.erase(one);
  }
}

Tasks::Outputs Tasks::left(const ProgramId& program) {
  Outputs out;
  out.why = "the program that wanted it has left or taken it back";
  for (auto one = open_.begin(); one != open_.end();) {
    if (one->program != program || is_stop(*one)) {
      ++one;
      continue;
    }
    if (one->brief)
      release(out);
    cancel(*one, one->goal.speaker, ": " + out.why, out);
    one = open_.erase(one);
  }
  drop_later(
      ": " + out.why, [&](const Later& one) { return one.order.program == program; }, out);
  return out;
}

Tasks::Outputs Tasks::later(double time, std::vector<Task> steps, const Utterance& order) {
  Outputs out;
  Later one{time, order, std::move(steps)};
  std::erase_if(later_, [&](const Later& known) {  // the order is said once more
    return same_person(known.order.speaker, order.speaker) && whole_text(known) == whole_text(one);
  });
  const bool many = later_.size() >= kMostLater;
  if (!many)
    later_.push_back(std::move(one));
  out.said.push_back({order.id, order.speaker,
                      many ? "I have too much to do later already" : whole_text(later_.back()),
                      many, many});
  return out;
}

Tasks::Outputs Tasks::stopped(const std::string& who) {
  Outputs out;
  drop_later(
      ": stopped by " + who, [](const Later&) { return true; }, out);
  return out;
}

std::vector<Tasks::Later> Tasks::take_due(double now) {
  std::vector<Later> due;
  for (Later& one : later_)
    if (one.time <= now)
      due.push_back(std::move(one));
  std::erase_if(later_, [&](const Later& one) { return one.time <= now; });
  return due;
}

void Tasks::drop_later(const std::string& why, const std::function<bool(const Later&)>& meant,
                       Outputs& out) {
  for (const Later& one : later_)
    if (meant(one))
      out.said.push_back({one.order.id, one.order.speaker,
                          "I drop the order for later: " + whole_text(one) + why, true});
  std::erase_if(later_, meant);
}

Tasks::Outputs Tasks::deny(const Task& task, const Utterance& utterance) const {
  Outputs out;
  const std::string ends = named_task(task, utterance.speaker);
  out.denied = {.act = v1::AUDIT_REFUSED,
                .who = named(named_person(utterance.speaker) + " (by words)", utterance.person),
                .text = "to end " + ends + ": " + quoted(words_said(utterance))};
  out.said.push_back({utterance.id, utterance.speaker,
                      "that would end " + ends + ": " + task.goal.person->name +
                          " or an operator may do that, and everybody may stop me",
                      true, true});
  return out;
}

Tasks::Outputs Tasks::want(std::vector<Task> steps, const Utterance& utterance, bool drops) {
  Outputs out;
  if (steps.empty())
    return out;
  const bool all_brief =
      std::all_of(steps.begin(), steps.end(), [](const Task& step) { return step.brief; });
  for (Task& step : steps) {
    step.answers = utterance.id;
    step.program = utterance.program;
    step.brief = all_brief;
    step.goal.person = utterance.person;
  }
  out.why = claim_source(utterance);
  const bool stop = is_stop(steps.front());
  const bool brief = !stop && all_brief;
  const bool waits = brief && steps.front().goal.functor == "pause";  // anybody may say so
  for (const Task& one : open_)
    if (!stop && !waits && !is_stop(one) && (one.brief || !brief) &&
        !may_end(utterance.person, one.goal.person))
      return deny(one, utterance);
  const Task* const other = task();
  if (!stop && !brief && !drops && other != nullptr &&
      !same_person(other->goal.speaker, utterance.speaker)) {
    const std::string owner = named_person(other->goal.speaker);
    out.said.push_back(
        {utterance.id, utterance.speaker,
         (front_ && front_->before_task
              ? "I have an order of " + owner + ": after " + front_->name + ", " + other->what
          : other->doing.empty() ? "I am at work for " + owner + ": " + other->what
                                 : "I am " + other->doing + " for " + owner) +
             ". Shall I drop that?",
         true, true});
    out.asks = std::move(steps);
    return out;
  }
  Task first = std::move(steps.front());
  first.then.assign(std::make_move_iterator(steps.begin() + 1),
                    std::make_move_iterator(steps.end()));
  const std::string after = after_others(first);
  std::string text = after + whole_text(first);
  if (brief && other != nullptr)
    text += ", and then I go on with " + (after.empty() && front_ && front_->before_task
                                              ? front_->name
                                              : named_task(*other, utterance.speaker));
  const Said announced{utterance.id, utterance.speaker, text, false};
  if (stop && other != nullptr) {
    stopped_ = {*other};
    for (Task& step : std::exchange(stopped_.front().then, {}))
      stopped_.push_back(std::move(step));
  } else if (!stop && !brief) {
    stopped_.clear();
  }
  if (stop) {
    out.said.push_back(announced);
    drop_later(
        ": " + out.why, [](const Later&) { return true; }, out);
  }
  if (!brief)
    drop(false, utterance.speaker, words_said(utterance), out);
  drop(true, utterance.speaker, words_said(utterance), out);
  if (!stop)
    out.said.push_back(announced);
  begin(std::move(first), out);
  return out;
}

Tasks::Outputs Tasks::go_on(const Utterance& utterance) {
  const auto wait = std::find_if(open_.begin(), open_.end(),
                                 [](const Task& one) { return one.goal.functor == "pause"; });
  if (wait != open_.end() && !may_end(utterance.person, wait->goal.person))
    return deny(*wait, utterance);
  if (wait != open_.end()) {
    const std::uint64_t tag = wait->goal.tag;
    Outputs out = ended({tag, true, "I was told to go on"});
    out.canceled.push_back(tag);
    out.why = claim_source(utterance);
    const std::string present = going_on(utterance.speaker);
    out.said.push_back(
        {utterance.id, utterance.speaker, present.empty() ? "I go on" : present.substr(2), true});
    return out;
  }
  if (task() == nullptr && !stopped_.empty())
    return want(std::exchange(stopped_, {}), utterance);
  Outputs out;
  const std::string present = going_on(utterance.speaker);
  out.said.push_back({utterance.id, utterance.speaker,
                      present.empty() ? "there is nothing to go on with" : "good" + present, true});
  return out;
}

std::string Tasks::going_on(const std::string& listener) const {
  if (front_ && front_->before_task)
    return ": I go on with " + front_->name;
  const Task* other = task();
  for (const Task& one : open_)
    if (other == nullptr && !is_stop(one))
      other = &one;
  return other == nullptr ? std::string() : ": I go on with " + named_task(*other, listener);
}

Tasks::Outputs Tasks::ended(const Outcome& outcome) {
  Outputs out;
  if (outcome.tag == hold_)
    hold_ = 0;
  const auto found = std::find_if(open_.begin(), open_.end(),
                                  [&](const Task& one) { return one.goal.tag == outcome.tag; });
  if (found == open_.end())
    return out;
  Task task = std::move(*found);
  open_.erase(found);
  const bool more = !task.then.empty();
  // On the bus a new stop ends the one before.
  const bool replaced = is_stop(task) && std::any_of(open_.begin(), open_.end(), is_stop);
  std::string text = replaced          ? "done: I was told again to stop"
                     : outcome.success ? "done: " + outcome.reason
                                       : "I could not: " + outcome.reason;
  if (more && !outcome.success)
    text += "; so the rest is not done";
  out.said.push_back({task.answers, task.goal.speaker, text, !more || !outcome.success});
  if (!more || !outcome.success) {
    if (task.brief)
      release(out);
    return out;
  }
  Task next = std::move(task.then.front());
  next.then.assign(std::make_move_iterator(task.then.begin() + 1),
                   std::make_move_iterator(task.then.end()));
  out.said.push_back({next.answers, next.goal.speaker, after_others(next) + next.what, false});
  begin(std::move(next), out);
  return out;
}

const Task* Tasks::find(std::uint64_t tag) const {
  const auto found = std::find_if(open_.begin(), open_.end(),
                                  [&](const Task& one) { return one.goal.tag == tag; });
  return found == open_.end() ? nullptr : &*found;
}

void Tasks::asked(std::uint64_t tag, const GoalRef& goal, const std::string& sample) {
  for (Task& one : open_)
    if (one.goal.tag == tag) {
      one.ref = goal;
      one.sample = sample;
    }
}

std::vector<LastingGoal> Tasks::lasting() const {
  std::vector<LastingGoal> goals;
  for (const Task& one : open_)
    if (one.ref != GoalRef{})
      goals.push_back({one.goal.tag, one.ref, one.sample});
  return goals;
}

bool Tasks::note_waiting(std::uint64_t tag) {
  for (Task& one : open_)
    if (one.goal.tag == tag)
      return !std::exchange(one.waits, true);
  return false;
}

std::string Tasks::doing_later() const {
  std::string text;
  for (const Later& one : later_)
    text += (text.empty() ? "" : "; ") + whole_text(one);
  return text;
}

std::string Tasks::set_pace(bool slow, const std::string& source, const std::string& listener) {
  std::string names;
  for (Task& one : open_) {
    if (is_stop(one))
      continue;
    names += (names.empty() ? "" : " and ") + named_task(one, listener);
    const auto set = [&](Task& step) {
      step.rules.slow = slow;
      step.rules.source = source;
    };
    set(one);
    std::for_each(one.then.begin(), one.then.end(), set);
  }
  return names;
}

UtteranceId Tasks::spoken_for() const {
  UtteranceId answers{};
  for (const Task& one : open_)
    if (answers == UtteranceId{} || !one.brief)
      answers = one.answers;
  return answers;
}

void Tasks::archive(Archive& a) {
  std::vector<Task> open = open_;
  std::erase_if(open, [](const Task& one) { return one.ref == GoalRef{}; });
  std::vector<Later> later = later_;
  std::erase_if(later, [](const Later& one) { return one.order.program != ProgramId{}; });
  a("tag", tag_)("open", open)("later", later)("stopped", stopped_);
  if (a.restores()) {
    open_ = std::move(open);
    later_ = std::move(later);
  }
}

}  // namespace saphira::agent_interface
