#include "language/compiler.hpp"

#include "language/goals.hpp"
#include "saphira/base/units.hpp"

namespace saphira::intentions {
namespace {

/// Of one (defintention ...): its name, options and parameters; the goal-sets are for Goals.
class Compiler {
 public:
  Compiler(const Reader& reader, const Functions& functions, std::vector<Diagnostic>& troubles)
      : definition_(reader, functions, troubles) {}

  std::optional<Schema> compile(const Form& form, const std::string& file) {
    try {
      define(form, file);
    } catch (const Stop&) {
    }
    if (definition_.wrong())
      return std::nullopt;
    return finish();
  }

 private:
  void define(const Form& form, const std::string& file) {
    program_.file = file;
    program_.line = form.line;
    if (!form.is_list() || form.items.empty() || !form.items[0].is("defintention"))
      definition_.fail(form, "expected (defintention :name ...)" + found(form));
    if (form.items.size() < 2 || form.items[1].is_list() ||
        form.items[1].kind == Form::Kind::kNumber || form.items[1].text.empty())
      definition_.fail(form.items.size() < 2 ? form : form.items[1],
                       "expected the activity's name, such as :plan-and-execute");
    program_.name = form.items[1].text;
    const Parts given = definition_.parts(form, 2,
                                          {"params", "goals", "timeout", "priority", "concurrent",
                                           "level", "progress", "documentation", "doc"});
    if (!given.items.empty())
      definition_.fail(*given.items[0],
                       "expected :params, :goals or another option" + found(*given.items[0]));
    if (const Form* const params = given.option("params"))
      parameters(*params);
    program_.parameters = program_.locals.size();
    for (const char* const key : {"documentation", "doc"}) {
      if (const Form* const doc = given.option(key)) {
        if (doc->kind != Form::Kind::kText)
          definition_.fail(*doc, "expected a text" + found(*doc));
        summary_ = doc->text;
      }
    }
    if (const Form* const timeout = given.option("timeout"))
      program_.timeout = constant_number(*timeout, 0.1, 1e7, "seconds");
    if (const Form* const priority = given.option("priority"))
      priority_ = static_cast<int>(constant_number(*priority, -1000.0, 1000.0, "a whole number"));
    if (const Form* const concurrent = given.option("concurrent"))
      concurrent_ = literal(*concurrent).truthy();
    const Form* const goals = given.option("goals");
    if (goals == nullptr)
      definition_.fail(form, "expected :goals '(...)");
    if (const Form* const level = given.option("level"))
      program_.level = expressions_.expression(*level, false);
    if (const Form* const progress = given.option("progress"))
      program_.progress = expressions_.expression(*progress, false);
    Goals(definition_, expressions_).body(*goals);
    definition_.check_locals();
  }

  double constant_number(const Form& form, double low, double high, const char* what) {
    if (form.kind != Form::Kind::kNumber || form.number < low || form.number > high)
      definition_.fail(form, "expected " + std::string(what) + " from " + plain(low) + " to " +
                                 plain(high) + found(form));
    return form.number;
  }

  void parameters(const Form& form) {
    if (form.is("nil"))
      return;
    if (!form.is_list())
      definition_.fail(form, "expected the parameters in parentheses" + found(form));
    for (const Form& item : form.items)
      parameter(item);
  }

  void parameter(const Form& form) {
    const Form& name = form.is_list() && !form.items.empty() ? form.items[0] : form;
    if (name.kind != Form::Kind::kName || starred(name.text))
      definition_.fail(name,
                       "expected a parameter, such as dest or (speed :number 0.3)" + found(name));
    if (definition_.is_local(normal(name.text)))
      definition_.fail(name, "parameter " + quoted(name.text) + " is there twice");
    Parameter parameter;
    parameter.name = name.text;
    parameter.any = true;
    parameter.required = true;
    parameter.low = -1e9;
    parameter.high = 1e9;
    Value usual;
    if (form.is_list()) {
      std::size_t next = 1;
      bool typed = false;
      if (next < form.items.size() && form.items[next].kind == Form::Kind::kKeyword) {
        const Form& type = form.items[next];
        bool known = true;
        if (type.is("number"))
          parameter.kind = ArgumentKind::number;
        else if (type.is("text") || type.is("place") || type.is("symbol") || type.is("name"))
          parameter.kind = ArgumentKind::text;
        else if (type.is("point"))
          parameter.kind = ArgumentKind::point;
        else
          known = false;
        if (known)
          parameter.any = false;
        parameter.place = type.is("place");
        typed = known || type.is("any") || type.is("list");
        if (typed)
          ++next;
        else if (!type.is("unit") && !type.is("low") && !type.is("high") && !type.is("doc"))
          definition_.fail(type,
                           "expected :number, :text, :place, :point, :list or :any" + found(type));
      }
      if (next < form.items.size() && form.items[next].kind != Form::Kind::kKeyword) {
        usual = literal(form.items[next]);
        parameter.required = false;
        const bool fits = usual.nil() || parameter.any ||
                          (parameter.kind == ArgumentKind::number && usual.number() != nullptr) ||
                          (parameter.kind == ArgumentKind::text && usual.text() != nullptr);
        if (!fits)
          definition_.fail(form.items[next],
                           "expected a default of the parameter's type" + found(form.items[next]));
        ++next;
      }
      const Parts options = definition_.parts(form, next, {"unit", "low", "high", "doc"});
      // A parameter with a number as its default, or with a unit or limits, is a number.
      const bool is_number = options.option("unit") != nullptr ||
                             options.option("low") != nullptr ||
                             options.option("high") != nullptr || usual.number() != nullptr;
      if (parameter.any && !typed && is_number) {
        if (!usual.nil() && usual.number() == nullptr)
          definition_.fail(form.items[1],
                           "expected a number as the default of a parameter with "
                           ":unit, :low or :high" +
                               found(form.items[1]));
        parameter.any = false;
        parameter.kind = ArgumentKind::number;
      } else if (is_number && usual.number() == nullptr &&
                 (parameter.any || parameter.kind != ArgumentKind::number)) {
        definition_.fail(form, "expected :unit, :low and :high with :number alone");
      }
      if (!options.items.empty())
        definition_.fail(*options.items[0],
                         "expected :unit, :low, :high or :doc" + found(*options.items[0]));
      if (const Form* const unit = options.option("unit")) {
        const Unit* const known = find_unit(unit->text);
        if (known == nullptr || known->name != known->si)
          definition_.fail(*unit, "expected an SI unit (m, s, rad, m/s or rad/s)" + found(*unit));
        parameter.unit = unit->text;
      }
      if (const Form* const low = options.option("low"))
        parameter.low = constant_number(*low, -1e9, 1e9, "a number");
      if (const Form* const high = options.option("high"))
        parameter.high = constant_number(*high, -1e9, 1e9, "a number");
      if (parameter.low > parameter.high)
        definition_.fail(form, "expected :low below :high");
      if (const double* const given = usual.number())
        if (!parameter.any && (*given < parameter.low || *given > parameter.high))
          definition_.fail(form, "expected a default within :low and :high");
    }
    if (const double* const given = usual.number())
      parameter.usual = *given;
    else if (const std::string* const given_text = usual.text())
      parameter.usual_text = *given_text;
    definition_.slot(name);
    definition_.binds(name);
    program_.usual.push_back(std::move(usual));
    parameters_.push_back(std::move(parameter));
  }

  Schema finish() {
    Schema schema;
    schema.name = program_.name;
    schema.summary = summary_;
    schema.parameters = parameters_;
    schema.source = program_.file;
    schema.concurrent = concurrent_;
    schema.priority = priority_;
    schema.timeout = program_.timeout;
    std::shared_ptr<const Program> program = definition_.release();
    schema.program = program;
    schema.bind = [program](const Bindings& bindings) { return make_machine(program, bindings); };
    schema.make = [program](const Arguments& arguments) {
      Bindings bindings;
      for (const Argument& argument : arguments)
        bindings.emplace_back(argument.name, value_of(argument));
      return make_machine(program, bindings);
    };
    return schema;
  }

  Definition definition_;
  Program& program_ = definition_.program();
  Expressions expressions_{definition_};
  std::vector<Parameter> parameters_;
  std::string summary_;
  int priority_ = 0;
  bool concurrent_ = false;
};

}  // namespace

std::optional<Schema> compile_activity(const Form& form, const std::string& file,
                                       const Reader& reader, const Functions& functions,
                                       std::vector<Diagnostic>& troubles) {
  return Compiler(reader, functions, troubles).compile(form, file);
}

}  // namespace saphira::intentions
