#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/text.hpp"

namespace saphira::behaviors::language {
namespace {

constexpr double kMillimetre = 0.001;  // of the language's millimetres

void run(const Program& program, const std::vector<Instruction>& code, double* r, Call& call) {
  const Instruction* const begin = code.data();
  const Instruction* const end = begin + code.size();
  for (const Instruction* i = begin; i != end; ++i) {
    switch (i->op) {
      case Op::move:
        r[i->to] = r[i->a];
        break;
      case Op::move3:
        std::copy_n(r + i->a, 3, r + i->to);
        break;
      case Op::jump:
        i = begin + i->a - 1;
        break;
      case Op::jump_unless:
        if (r[i->a] == 0.0)
          i = begin + i->b - 1;
        break;
      case Op::call:
        program.calls[i->b](call, r + i->a, r + i->to);
        break;
      default:
        r[i->to] = apply(i->op, r[i->a], r[i->b], r[i->c]);
        break;
    }
  }
}

class Instance : public Behavior {
 public:
  explicit Instance(std::shared_ptr<const Program> program)
      : program_(std::move(program)), registers_(program_->registers) {}

  void init(const Parameters& parameters, const Context& context) override {
    Evaluation evaluation;
    Call call = begin(parameters, context, evaluation);
    run(*program_, program_->init, registers_.data(), call);
    for (const Program::Kept& kept : program_->kept)
      for (const Old& old : old_)
        if (old.name == kept.name && old.type == kept.type)
          std::ranges::copy(old.registers, registers_.data() + kept.at);
    old_.clear();
  }

  Evaluation update(const Parameters& parameters, const Context& context) override {
    Evaluation evaluation;
    Call call = begin(parameters, context, evaluation);
    double* const r = registers_.data();
    run(*program_, program_->update, r, call);
    evaluation.rules.reserve(program_->rules.size());
    for (const Program::RuleCode& rule : program_->rules)
      recommend(rule, evaluation);
    evaluation.activity = {fuzzy("Turn", r[program_->turn], evaluation),
                           fuzzy("Speed", r[program_->speed], evaluation),
                           fuzzy("Goal", r[program_->goal], evaluation),
                           fuzzy("Progress", r[program_->progress], evaluation)};
    evaluation.variables.reserve(program_->shown.size());
    for (const Program::Shown& shown : program_->shown)
      evaluation.variables.emplace_back(shown.name, r[shown.at]);
    return evaluation;
  }

  void take_over(const Behavior& old) override {
    if (const auto* const before = dynamic_cast<const Instance*>(&old))
      for (const Program::Kept& kept : before->program_->kept) {
        const double* const from = before->registers_.data() + kept.at;
        old_.push_back({kept.name, kept.type, {from, from + (kept.type == Type::point ? 3 : 1)}});
      }
  }

  void archive(Archive& a) override {
    a("registers", registers_)("old", old_);
    a.expect(registers_.size() == program_->registers.size(),
             counted(program_->registers.size(), "register") + " of " + program_->name);
  }

 private:
  /// A variable that persists.
  struct Old {
    std::string name;
    Type type = Type::real;
    std::vector<double> registers;
  };

  /// Loads the parameters.
  Call begin(const Parameters& parameters, const Context& context, Evaluation& evaluation) {
    for (std::size_t i = 0; i < program_->parameters.size(); ++i) {
      const Program::Binding& binding = program_->parameters[i];
      double* const to = registers_.data() + binding.to;
      if (binding.type == Type::point) {
        const std::optional<Pose> in_odom = parameters.point(i);
        // An absent point is NaN: a behavior that does not check for it gets an error.
        const double none = std::numeric_limits<double>::quiet_NaN();
        const Pose local =
            in_odom ? relative(context.robot.pose_in_odom, *in_odom) : Pose{none, none, none};
        to[0] = local.x / kMillimetre;
        to[1] = local.y / kMillimetre;
        to[2] = local.th;
      } else if (binding.type == Type::text) {
        *to = static_cast<double>(parameters.choice(i));
      } else {
        *to = parameters.number(i) * binding.factor;
        if (binding.type == Type::integer)
          *to = std::trunc(*to);
      }
    }
    Call call;
    call.context = &context;
    call.evaluation = &evaluation;
    return call;
  }

  static void complain(Evaluation& evaluation, const std::string& what) {
    evaluation.trouble += (evaluation.trouble.empty() ? "" : ", ") + what + " is not a number";
  }

  static double fuzzy(const char* name, double value, Evaluation& evaluation) {
    if (!std::isnan(value))
      return std::clamp(value, 0.0, 1.0);
    complain(evaluation, name);
    return 0.0;
  }

  void recommend(const Program::RuleCode& code, Evaluation& evaluation) const {
    const double* const r = registers_.data();
    Rule rule;
    rule.name = code.name;
    rule.strength = r[code.strength];
    rule.value = r[code.value];
    switch (code.kind) {
      case ParsedRule::Kind::either:
        if (code.limited)
          rule.value =
              std::clamp(rule.value, -std::abs(r[code.modifier]), std::abs(r[code.modifier]));
        [[fallthrough]];
      case ParsedRule::Kind::left:
        rule.action = rule.value >= 0.0 ? Action::turn_left : Action::turn_right;
        rule.value = std::abs(rule.value);
        break;
      case ParsedRule::Kind::right:
        rule.action = rule.value >= 0.0 ? Action::turn_right : Action::turn_left;
        rule.value = std::abs(rule.value);
        break;
      case ParsedRule::Kind::speed:
        rule.action = Action::speed;
        rule.value *= kMillimetre;
        break;
      case ParsedRule::Kind::accelerate:
      case ParsedRule::Kind::decelerate:
        rule.action = (code.kind == ParsedRule::Kind::accelerate) == (rule.value >= 0.0)
                          ? Action::accelerate
                          : Action::decelerate;
        rule.value = std::abs(rule.value) * kMillimetre;
        break;
    }
    if (!std::isfinite(rule.value) || std::isnan(rule.strength)) {
      complain(evaluation, "rule \"" + code.name + "\"");
      rule.value = 0.0;
      rule.strength = 0.0;
    }
    rule.strength = std::clamp(rule.strength, 0.0, 1.0);
    evaluation.rules.push_back(std::move(rule));
  }

  std::shared_ptr<const Program> program_;
  std::vector<double> registers_;
  std::vector<Old> old_;  ///< of the version before, until init
};

}  // namespace

std::unique_ptr<Behavior> make_instance(std::shared_ptr<const Program> program) {
  return std::make_unique<Instance>(std::move(program));
}

}  // namespace saphira::behaviors::language
