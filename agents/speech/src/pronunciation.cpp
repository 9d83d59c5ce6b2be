#include "saphira/speech/pronunciation.hpp"

#include <flite/flite.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

#include "saphira/base/text.hpp"

extern "C" cst_lexicon* cmu_lex_init();

namespace saphira::speech {
namespace {

constexpr std::array kDigits{"zero", "one", "two",   "three", "four",
                             "five", "six", "seven", "eight", "nine"};
constexpr std::array kTens{"",      "ten",   "twenty",  "thirty", "forty",
                           "fifty", "sixty", "seventy", "eighty", "ninety"};
constexpr std::array kTeens{"ten",     "eleven",  "twelve",    "thirteen", "fourteen",
                            "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"};

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string two_digits(const std::string& digits) {
  const auto ten = static_cast<std::size_t>(digits[0] - '0');
  const auto one = static_cast<std::size_t>(digits[1] - '0');
  if (ten == 1)
    return kTeens.at(one);
  return std::string(kTens.at(ten)) + (one > 0 ? std::string(" ") + kDigits.at(one) : "");
}

/// flite's phones as those of the recognizer.
std::string as_cmu(std::string phone) {
  std::erase_if(phone, is_digit);
  for (char& c : phone)
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return phone == "AX" ? "AH" : phone == "AXR" ? "ER" : phone;
}

/// By the rules of flite's lexicon.
std::string guessed(const std::string& word) {
  static cst_lexicon* const lexicon = cmu_lex_init();
  cst_val* const found = lex_lookup(lexicon, word.c_str(), nullptr, nullptr);
  std::string out;
  for (const cst_val* each = found; each != nullptr; each = val_cdr(each))
    out += (out.empty() ? "" : " ") + as_cmu(val_string(val_car(each)));
  delete_val(found);
  return out;
}

}  // namespace

const std::vector<std::string>& phones() {
  static const std::vector<std::string> all{
      "AA", "AE", "AH", "AO", "AW", "AY", "B",  "CH", "D", "DH", "EH", "ER", "EY",
      "F",  "G",  "HH", "IH", "IY", "JH", "K",  "L",  "M", "N",  "NG", "OW", "OY",
      "P",  "R",  "S",  "SH", "T",  "TH", "UH", "UW", "V", "W",  "Y",  "Z",  "ZH"};
  return all;
}

bool is_code(const std::string& word) {
  return std::ranges::any_of(word, is_digit) &&
         std::ranges::any_of(word, [](unsigned char c) { return std::isalpha(c) != 0; });
}

std::string spelled(const std::string& word) {
  std::string out;
  for (const char c : word) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0)
      continue;
    out += out.empty() ? "" : " ";
    if (is_digit(c))
      out += kDigits.at(static_cast<std::size_t>(c - '0'));
    else
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

Pronunciations::Pronunciations(std::string_view text, const std::string& file,
                               Dictionary dictionary)
    : dictionary_(std::move(dictionary)) {
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string all = line;
    line = line.substr(0, line.find('#'));
    std::istringstream words(line);
    std::string word;
    if (!(words >> word))
      continue;
    std::string sound;
    for (std::string phone; words >> phone;) {
      if (std::ranges::find(phones(), phone) == phones().end())
        throw FileError(file, number, static_cast<int>(line.find(phone, word.size())) + 1,
                        "expected phones of the CMU dictionary, such as F L EY K IY", all);
      sound += (sound.empty() ? "" : " ") + phone;
    }
    if (sound.empty())
      throw FileError(file, number, static_cast<int>(line.size()) + 1,
                      "expected the phones of " + word + ", such as F L EY K IY", all);
    own_[word].push_back(sound);
  }
}

Phones Pronunciations::of(const std::string& word) const {
  const auto own = own_.find(word);
  if (own != own_.end())
    return own->second;
  if (word == "'s")
    return {"Z", "S", "IH Z"};
  if (is_code(word))
    return of_code(word);
  if (!word.empty() && std::ranges::all_of(word, is_digit))
    return of_code(word);
  Phones known = dictionary_(word);
  if (!known.empty())
    return known;
  // "forty-five"
  if (const std::size_t hyphen = word.find('-');
      hyphen != std::string::npos && hyphen > 0 && hyphen + 1 < word.size())
    return {of(word.substr(0, hyphen)).front() + " " + of(word.substr(hyphen + 1)).front()};
  const std::string sound = guessed(word);
  return {sound.empty() ? "AH" : sound};
}

/// "two three one", and as people say numbers of rooms: "two thirty one", "two hundred thirty one".
Phones Pronunciations::of_code(const std::string& word) const {
  std::vector<std::string> texts{""};
  for (std::size_t i = 0; i < word.size();) {
    std::vector<std::string> here;
    std::size_t end = i;
    while (end < word.size() && is_digit(word[end]))
      ++end;
    const std::string digits = word.substr(i, end - i);
    if (digits.size() == 3) {
      const std::string hundred = kDigits.at(static_cast<std::size_t>(digits[0] - '0'));
      const std::string rest = two_digits(digits.substr(1));
      here = {spelled(digits), hundred + " " + rest, hundred + " hundred " + rest,
              hundred + " hundred and " + rest};
    } else if (digits.size() == 2) {
      here = {spelled(digits), two_digits(digits)};
    } else {
      end = std::max(end, i + 1);
      here = {spelled(word.substr(i, end - i))};
    }
    std::vector<std::string> longer;
    for (const std::string& before : texts)
      for (const std::string& part : here)
        longer.push_back(before + (before.empty() || part.empty() ? "" : " ") + part);
    texts = std::move(longer);
    i = end;
  }
  Phones out;
  for (const std::string& text : texts) {
    std::string sound;
    std::istringstream parts(text);
    for (std::string part; parts >> part;) {
      // The letter, not the article.
      const std::string one = part == "a" ? "EY" : of(part).front();
      sound += (sound.empty() ? "" : " ") + one;
    }
    out.push_back(sound);
  }
  return out;
}

}  // namespace saphira::speech
