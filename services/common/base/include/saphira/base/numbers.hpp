#pragma once

#include <string>

// Numbers as text; read back by LineReader::number.
namespace saphira {

/// For people: six digits, "0.3", "1e+06".
std::string plain(double value);

/// With all digits: it reads back to the same number.
std::string exact(double value);

/// Without an exponent, and without zeros at the end: decimal(1.5, 3) is "1.5".
std::string decimal(double value, int digits);

}  // namespace saphira
