#pragma once

// Samples of the contract as CDR.

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "saphira/idl/members.hpp"

namespace saphira::bus::internal {

/// std::length_error: a sequence is longer than its bound.
class CdrWriter {
 public:
  explicit CdrWriter(eprosima::fastcdr::Cdr& cdr) : cdr_(cdr) {}

  template <class T>
  void operator()([[maybe_unused]] const Member& member, const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      cdr_ << value;
    } else if constexpr (std::is_enum_v<T>) {
      cdr_ << static_cast<std::uint32_t>(value);
    } else {
      visit_members(value, *this);
    }
  }
  template <class T>
  void operator()(const Member& member, const std::vector<T>& values) {
    if (values.size() > member.bound)
      throw std::length_error(member.name);
    cdr_ << static_cast<std::uint32_t>(values.size());
    for (const T& value : values)
      (*this)(member, value);
  }
  template <class T, std::size_t N>
  void operator()(const Member& member, const std::array<T, N>& values) {
    for (const T& value : values)
      (*this)(member, value);
  }

 private:
  eprosima::fastcdr::Cdr& cdr_;
};

/// std::length_error as above, or where a sequence has more elements than `size`, the bytes of all.
class CdrReader {
 public:
  CdrReader(eprosima::fastcdr::Cdr& cdr, std::size_t size) : cdr_(cdr), size_(size) {}

  template <class T>
  void operator()([[maybe_unused]] const Member& member, T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      cdr_ >> value;
    } else if constexpr (std::is_enum_v<T>) {
      std::uint32_t number = 0;
      cdr_ >> number;
      value = static_cast<T>(number);
    } else {
      visit_members(value, *this);
    }
  }
  template <class T>
  void operator()(const Member& member, std::vector<T>& values) {
    std::uint32_t count = 0;
    cdr_ >> count;
    if (count > member.bound || count > size_)
      throw std::length_error(member.name);
    values.resize(count);
    for (T& value : values)
      (*this)(member, value);
  }
  template <class T, std::size_t N>
  void operator()(const Member& member, std::array<T, N>& values) {
    for (T& value : values)
      (*this)(member, value);
  }

 private:
  eprosima::fastcdr::Cdr& cdr_;
  std::size_t size_;
};

/// How many bytes a sample has.
class CdrSize {
 public:
  template <class T>
  void operator()([[maybe_unused]] const Member& member, const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      bytes = (bytes + sizeof(T) - 1) / sizeof(T) * sizeof(T) + sizeof(T);
    } else if constexpr (std::is_same_v<T, std::string>) {
      (*this)(member, std::uint32_t{});
      bytes += std::strlen(value.c_str()) + 1;  // a zero ends it, as in the other languages
    } else {
      visit_members(value, *this);
    }
  }
  template <class T>
  void operator()(const Member& member, const std::vector<T>& values) {
    (*this)(member, std::uint32_t{});
    for (const T& value : values)
      (*this)(member, value);
  }
  template <class T, std::size_t N>
  void operator()(const Member& member, const std::array<T, N>& values) {
    for (const T& value : values)
      (*this)(member, value);
  }

  std::size_t bytes = 0;
};

/// The key of a sample as it is on the wire: big-endian, with zeros behind.
struct CdrKey {
  template <class T>
  explicit CdrKey(const T& sample) {
    eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::BIG_ENDIANNESS);
    CdrWriter writer(cdr);
    visit_members(sample, [&](const Member& member, const auto& value) {
      if (member.key)
        writer(member, value);
    });
    size = cdr.getSerializedDataLength();
  }

  std::array<char, 16> bytes{};
  std::size_t size = 0;
};

/// Before the members: that they are little-endian.
inline constexpr std::uint32_t kEncapsulationBytes = 4;

/// How many bytes a sample has, with encapsulation.
template <class T>
std::uint32_t cdr_size(const T& sample) {
  CdrSize size;
  visit_members(sample, size);
  return kEncapsulationBytes + static_cast<std::uint32_t>(size.bytes);
}

/// Returns how many bytes it wrote. An exception: the sample has more, or a sequence over its
/// bound.
template <class T>
std::uint32_t write_cdr(const T& sample, char* data, std::size_t size) {
  using eprosima::fastcdr::Cdr;
  eprosima::fastcdr::FastBuffer buffer(data, size);
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  CdrWriter writer(cdr);
  visit_members(sample, writer);
  return static_cast<std::uint32_t>(cdr.getSerializedDataLength());
}

/// Reads what a stranger may have written. An exception: it is no such sample. A number that is no
/// enumerator is kept: a newer program may know it.
template <class T>
void read_cdr(char* data, std::size_t size, T& sample) {
  using eprosima::fastcdr::Cdr;
  eprosima::fastcdr::FastBuffer buffer(data, size);
  Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  cdr.read_encapsulation();
  CdrReader reader(cdr, size);
  visit_members(sample, reader);
}

}  // namespace saphira::bus::internal
