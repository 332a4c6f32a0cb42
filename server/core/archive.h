#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

// Values as bytes, exact to the last bit. The bytes do not name their types: only a program whose types have the same
// members in the same order can read them. One function lists the members of a type for both directions:
// - a member `template <class Archive> void archive(Archive& a)`, which calls a(first, second, ...), or
// - a function `archive(Archive& a, Type& value)` in the namespace of the type.
// Numbers are little-endian.
namespace spherule {

static_assert(std::endian::native == std::endian::little);

namespace archived {

// Types that are stored as their bytes in memory: numbers, and vectors of them.
template <class T>
constexpr bool isPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
inline constexpr bool isPlain<bool> = false;
template <glm::length_t L, class T, glm::qualifier Q>
constexpr bool isPlain<glm::vec<L, T, Q>> = true;
template <glm::length_t C, glm::length_t R, class T, glm::qualifier Q>
constexpr bool isPlain<glm::mat<C, R, T, Q>> = true;
template <class T, glm::qualifier Q>
constexpr bool isPlain<glm::qua<T, Q>> = true;

}  // namespace archived

// Appends values to bytes.
class Saver {
  public:
    static constexpr bool loads = false;

    template <class... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }
    std::string take() { return std::exchange(bytes_, {}); }

  private:
    void append(const void* from, std::size_t count) { bytes_.append(static_cast<const char*>(from), count); }
    void putSize(std::size_t size) { put(std::uint64_t{size}); }

    template <class T>
    void put(const T& value) {
        // The functions that list members take them as variables, for loading. Saving does not change them.
        if constexpr (archived::isPlain<T>)
            append(&value, sizeof value);
        else if constexpr (requires { const_cast<T&>(value).archive(*this); })
            const_cast<T&>(value).archive(*this);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
        else
            archive(*this, const_cast<T&>(value));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    }
    void put(const bool& value) { put(static_cast<std::uint8_t>(value)); }
    void put(const std::string& value) {
        putSize(value.size());
        append(value.data(), value.size());
    }
    template <class T>
    void put(const std::vector<T>& values) {
        putSize(values.size());
        if constexpr (archived::isPlain<T>)
            append(values.data(), values.size() * sizeof(T));
        else
            for (const T& value : values) put(value);
    }
    template <class T>
    void put(const std::deque<T>& values) {
        putSize(values.size());
        for (const T& value : values) put(value);
    }
    template <class T, std::size_t N>
    void put(const std::array<T, N>& values) {
        for (const T& value : values) put(value);
    }
    template <class T>
    void put(const std::optional<T>& value) {
        put(value.has_value());
        if (value) put(*value);
    }
    template <class... T>
    void put(const std::variant<T...>& value) {
        put(static_cast<std::uint8_t>(value.index()));
        std::visit([this](const auto& one) { put(one); }, value);
    }
    template <class T>
    void put(const std::shared_ptr<T>& value) {
        put(value != nullptr);
        if (value) put(*value);
    }

    std::string bytes_;
};

// Reads the values of such bytes, which may be damaged or hostile. After the first value that is cut off or invalid,
// all others are as if made new. Allocates at most some memory for each byte that is left.
class Loader {
  public:
    static constexpr bool loads = true;

    explicit Loader(std::string_view bytes) : left_(bytes) {}

    template <class... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    // Marks the bytes as invalid.
    void refuse() {
        failed_ = true;
        left_ = {};
    }
    [[nodiscard]] bool ok() const { return !failed_; }
    [[nodiscard]] std::size_t left() const { return left_.size(); }  // bytes

  private:
    bool read(void* to, std::size_t count) {
        if (failed_ || count > left_.size()) {
            refuse();
            return false;
        }
        if (count > 0) std::memcpy(to, left_.data(), count);
        left_.remove_prefix(count);
        return true;
    }
    // Returns the number of elements that follow; 0 if there cannot be so many.
    std::size_t size(std::size_t leastBytes) {
        std::uint64_t size = 0;
        get(size);
        if (size > left_.size() / leastBytes) refuse();
        return failed_ ? 0 : static_cast<std::size_t>(size);
    }

    template <class T>
    void get(T& value) {
        if constexpr (archived::isPlain<T>) {
            if (!read(&value, sizeof value)) value = T{};
        } else if constexpr (requires { value.archive(*this); }) {
            value.archive(*this);
        } else {
            archive(*this, value);
        }
    }
    void get(bool& value) {
        std::uint8_t byte = 0;
        get(byte);
        if (byte > 1) refuse();
        value = byte == 1;
    }
    void get(std::string& value) {
        value.resize(size(1));
        read(value.data(), value.size());
    }
    template <class T>
    void get(std::vector<T>& values) {
        if constexpr (archived::isPlain<T>) {
            values.resize(size(sizeof(T)));
            read(values.data(), values.size() * sizeof(T));
        } else {
            getEach(values);
        }
    }
    template <class T>
    void get(std::deque<T>& values) {
        getEach(values);
    }
    template <class List>
    void getEach(List& values) {
        values.clear();
        for (std::size_t left = size(1); left > 0 && ok(); --left) get(values.emplace_back());
    }
    template <class T, std::size_t N>
    void get(std::array<T, N>& values) {
        for (T& value : values) get(value);
    }
    template <class T>
    void get(std::optional<T>& value) {
        bool has = false;
        get(has);
        value.reset();
        if (has) get(value.emplace());
    }
    template <class... T>
    void get(std::variant<T...>& value) {
        std::uint8_t index = 0;
        get(index);
        if (index >= sizeof...(T)) return refuse();
        getKind(value, index, std::index_sequence_for<T...>());
    }
    template <class Variant, std::size_t... Index>
    void getKind(Variant& value, std::size_t index, std::index_sequence<Index...> /*all*/) {
        static_cast<void>(((Index == index ? (get(value.template emplace<Index>()), true) : false) || ...));
    }
    template <class T>
    void get(std::shared_ptr<T>& value) {
        bool has = false;
        get(has);
        value = nullptr;
        if (!has) return;
        auto made = std::make_shared<std::remove_const_t<T>>();
        get(*made);
        value = std::move(made);
    }

    std::string_view left_;
    bool failed_ = false;
};

}  // namespace spherule
