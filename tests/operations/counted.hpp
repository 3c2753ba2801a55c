// A double that counts what is done to it. The solvers' own sources are compiled with it in place of double
// (operations_test.cpp).
#ifndef TESTS_OPERATIONS_COUNTED_HPP
#define TESTS_OPERATIONS_COUNTED_HPP

#include <cmath>
#include <cstdint>
#include <cstring>

struct operations {
  long additions, multiplications, divisions, square_roots;
};

inline operations counter = {};

struct counted {
  double value;
  counted() = default;
  constexpr counted(double x) : value(x) {}
  constexpr counted(int x) : value(x) {}
  constexpr counted(long double x) : value((double)x) {}
  constexpr counted(size_t x) : value((double)x) {}
  explicit operator float() const { return (float)value; }
  explicit operator bool() const { return value != 0; }
};

inline counted operator+(counted a, counted b) { counter.additions++; return a.value + b.value; }
inline counted operator-(counted a, counted b) { counter.additions++; return a.value - b.value; }
inline counted operator*(counted a, counted b) { counter.multiplications++; return a.value * b.value; }
inline counted operator/(counted a, counted b) { counter.divisions++; return a.value / b.value; }
inline counted operator-(counted a) { return -a.value; }
inline counted &operator+=(counted &a, counted b) { return a = a + b; }
inline counted &operator-=(counted &a, counted b) { return a = a - b; }
inline counted &operator*=(counted &a, counted b) { return a = a * b; }
inline bool operator<(counted a, counted b) { return a.value < b.value; }
inline bool operator>(counted a, counted b) { return a.value > b.value; }
inline bool operator<=(counted a, counted b) { return a.value <= b.value; }
inline bool operator>=(counted a, counted b) { return a.value >= b.value; }
inline bool operator==(counted a, counted b) { return a.value == b.value; }
inline bool operator!=(counted a, counted b) { return a.value != b.value; }

inline counted sqrt(counted a) { counter.square_roots++; return std::sqrt(a.value); }
inline counted fabs(counted a) { return std::fabs(a.value); }
inline counted hypot(counted a, counted b) { return std::hypot(a.value, b.value); }
inline counted pow(counted a, counted b) { return std::pow(a.value, b.value); }
inline counted fmax(counted a, counted b) { return std::fmax(a.value, b.value); }
inline counted fmin(counted a, counted b) { return std::fmin(a.value, b.value); }
inline counted copysign(counted a, counted b) { return std::copysign(a.value, b.value); }
inline counted cos(counted a) { return std::cos(a.value); }
inline counted sin(counted a) { return std::sin(a.value); }
inline counted acos(counted a) { return std::acos(a.value); }
inline counted exp2(counted a) { return std::exp2(a.value); }
inline counted ldexp(counted a, int exponent) { return std::ldexp(a.value, exponent); }
inline counted log2(counted a) { return std::log2(a.value); }
inline bool isfinite(counted a) { return std::isfinite(a.value); }
inline bool isnan(counted a) { return std::isnan(a.value); }

// base/lanes.h with one lane. Choosing and comparing are not counted.
#define PSCN_BASE_LANES_H
#define LANES_INLINE static inline
enum { LANES = 1 };

struct lane_mask {
  bool value;
  int operator[](int) const { return value ? -1 : 0; }
};
inline lane_mask operator&(lane_mask a, lane_mask b) { return {a.value && b.value}; }
inline lane_mask operator~(lane_mask a) { return {!a.value}; }

struct lanes {
  counted value;
  counted &operator[](int) { return value; }
};
#define LANES_OPERATOR(op)                                                                                           \
  inline lanes operator op(lanes a, lanes b) { return {a.value op b.value}; }                                          \
  inline lanes operator op(counted a, lanes b) { return {a op b.value}; }                                              \
  inline lanes operator op(lanes a, counted b) { return {a.value op b}; }                                              \
  inline lanes operator op(lanes a, double b) { return {a.value op counted(b)}; }                                      \
  inline lanes operator op(double a, lanes b) { return {counted(a) op b.value}; }                                      \
  inline lanes operator op(int a, lanes b) { return {counted(a) op b.value}; }
LANES_OPERATOR(+)
LANES_OPERATOR(-)
LANES_OPERATOR(*)
LANES_OPERATOR(/)
#undef LANES_OPERATOR
#define LANES_COMPARISON(op)                                                                                           \
  inline lane_mask operator op(lanes a, lanes b) { return {a.value op b.value}; }                                      \
  inline lane_mask operator op(lanes a, double b) { return {a.value op counted(b)}; }
LANES_COMPARISON(<)
LANES_COMPARISON(>)
LANES_COMPARISON(<=)
LANES_COMPARISON(==)
#undef LANES_COMPARISON
inline lanes operator-(lanes a) { return {-a.value}; }
inline lanes &operator+=(lanes &a, lanes b) { return a = a + b; }
inline lanes &operator-=(lanes &a, lanes b) { return a = a - b; }
inline lanes &operator*=(lanes &a, lanes b) { return a = a * b; }
inline lanes lanes_all(counted a) { return {a}; }
inline lanes lanes_select(lane_mask mask, lanes a, lanes b) { return mask.value ? a : b; }
inline lanes lanes_abs(lanes a) { return {fabs(a.value)}; }
inline lanes lanes_max(lanes a, lanes b) { return a.value > b.value ? a : b; }
inline lanes lanes_sqrt(lanes a) { return {sqrt(a.value)}; }

#endif
