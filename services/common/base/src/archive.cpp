#include "saphira/base/archive.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "saphira/base/base64.hpp"
#include "saphira/base/numbers.hpp"

namespace saphira {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShown = 60;  // letters of a wrong value

Json parse(std::string_view text) {
  try {
    return Json::parse(text);
  } catch (const Json::exception&) {
    throw std::runtime_error("expected the state of this version as JSON, found " +
                             std::string(first_letters(text, kShown)));
  }
}

template <class T>
void pass(bool restores, Json& json, T& value) {
  if (restores)
    json.get_to(value);
  else
    json = value;
}

}  // namespace

/// The path from the whole to the present place.
struct Archive::Places {
  struct Place {
    Json* json;
    std::string name;
    std::size_t read = 0;  ///< members or elements
  };
  Json whole;
  std::vector<Place> path;

  Place& here() { return path.back(); }
};

Archive::Archive() : restores_(false), places_(std::make_unique<Places>()) {
  places_->path.push_back({&places_->whole, ""});
}

Archive::Archive(std::string_view text) : Archive() {
  restores_ = true;
  places_->whole = parse(text);
}

Archive::~Archive() = default;

std::string Archive::text() const {
  return places_->whole.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Archive::fail(const std::string& expected) const {
  std::string place;
  for (const Places::Place& each : places_->path)
    place += (place.empty() || each.name.starts_with('[') ? "" : ".") + each.name;
  const std::string found =
      places_->here().json->dump(-1, ' ', false, Json::error_handler_t::replace);
  throw std::runtime_error((place.empty() ? "" : place + ": ") + "expected " + expected +
                           ", found " + std::string(first_letters(found, kShown)));
}

void Archive::enter(std::string_view name) {
  Places::Place& here = places_->here();
  const std::string key(name);
  if (restores_) {
    if (!here.json->contains(key))
      fail("a member \"" + key + '"');
    ++here.read;
  }
  places_->path.push_back({&(*here.json)[key], key});
}

void Archive::enter_element() {
  Places::Place& here = places_->here();
  if (!restores_)
    here.json->push_back(nullptr);
  places_->path.push_back({&(*here.json)[here.read], "[" + std::to_string(here.read) + "]"});
  ++places_->path[places_->path.size() - 2].read;
}

void Archive::leave() {
  check_all_read();
  places_->path.pop_back();
}

void Archive::check_all_read() const {
  const Places::Place& here = places_->here();
  if (restores_ && here.json->is_object() && here.read > 0 && here.read < here.json->size())
    fail(counted(here.read, "member"));
}

std::size_t Archive::size(std::size_t count, bool exactly) {
  Json& json = *places_->here().json;
  if (!restores_) {
    json = Json::array();
    return count;
  }
  if (!json.is_array() || (exactly && json.size() != count))
    fail(exactly ? "a list of " + std::to_string(count) : "a list");
  return json.size();
}

bool Archive::present(bool value) {
  return restores_ ? !places_->here().json->is_null() : value;
}

void Archive::truth(bool& value) {
  Json& json = *places_->here().json;
  expect(json.is_boolean(), "true or false");
  pass(restores_, json, value);
}

void Archive::text(std::string& value) {
  Json& json = *places_->here().json;
  expect(json.is_string(), "a text");
  pass(restores_, json, value);
}

/// JSON has no infinite number, and no NaN: texts.
void Archive::number(double& value) {
  Json& json = *places_->here().json;
  if (!restores_) {
    if (std::isfinite(value))
      json = value;
    else
      json = exact(value);
    return;
  }
  const std::optional<double> endless =
      json.is_string() ? number_in<double>(json.get_ref<const std::string&>()) : std::nullopt;
  expect(json.is_number() || endless, "a number");
  value = endless ? *endless : json.get<double>();
}

void Archive::integer(std::int64_t& value, std::int64_t least, std::int64_t most) {
  Json& json = *places_->here().json;
  const auto fits = [&] {
    return json.is_number_unsigned()
               ? json.get<std::uint64_t>() <= static_cast<std::uint64_t>(most)
               : json.is_number_integer() && json.get<std::int64_t>() >= least;
  };
  expect(!restores_ || fits(),
         "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  pass(restores_, json, value);
}

void Archive::integer(std::uint64_t& value, std::uint64_t /*least*/, std::uint64_t most) {
  Json& json = *places_->here().json;
  expect(json.is_number_unsigned() && json.get<std::uint64_t>() <= most,
         "a whole number from 0 to " + std::to_string(most));
  pass(restores_, json, value);
}

void Archive::bytes(std::span<std::byte> bytes) {
  std::string coded = base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  text(coded);
  const auto read = restores_ ? from_base64(coded) : std::nullopt;
  expect(read && read->size() == bytes.size(), counted(bytes.size(), "byte") + " in base64");
  if (read)
    std::ranges::copy(*read, reinterpret_cast<char*>(bytes.data()));
}

void Archive::json(std::string& text) {
  Json& json = *places_->here().json;
  if (restores_)
    text = json.dump();
  else
    json = parse(text);
  // Its members are read later.
  places_->here().read = 0;
}

}  // namespace saphira
