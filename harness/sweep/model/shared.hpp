/// A value that is kept once for all its copies.
#pragma once

#include <memory>
#include <utility>

namespace loopbench::harness {

/// Copies cost as much as those of a pointer: for values that many records share.
template <class Value>
class Shared {
 public:
  Shared() : value_(std::shared_ptr<void>(), &none()) {}
  Shared(Value value)  // NOLINT(google-explicit-constructor): is a value
      : value_(std::make_shared<Value>(std::move(value))) {}
  /// `value` can be a part of something larger, see the aliasing constructor.
  explicit Shared(std::shared_ptr<Value> value) : value_(std::move(value)) {}

  const Value& operator*() const { return *value_; }
  const Value* operator->() const { return value_.get(); }

  /// For changes, which copies of this do not see. Not thread-safe.
  Value& edit() {
    if (value_.use_count() != 1) value_ = std::make_shared<Value>(*value_);
    return *value_;
  }

  friend bool operator==(const Shared& a, const Shared& b) {
    return a.value_ == b.value_ || *a == *b;
  }

 private:
  static Value& none() {
    static Value value;
    return value;
  }

  std::shared_ptr<Value> value_;
};

}  // namespace loopbench::harness
