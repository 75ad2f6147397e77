#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace bowstring {

/// N numbers. `T` may be any scalar with the arithmetic of a real number, forward-differentiation numbers included.
template <int N, class T = double>
struct Vector {
  std::array<T, static_cast<std::size_t>(N)> data{};

  static constexpr int size() noexcept { return N; }
  static constexpr Vector zero() { return {}; }
  static constexpr Vector unit(int axis) {
    Vector v;
    v[axis] = T(1);
    return v;
  }
  static constexpr Vector load(const T* numbers) {
    Vector v;
    for (int i = 0; i < N; ++i) v[i] = numbers[i];
    return v;
  }
  constexpr void store(T* numbers) const {
    for (int i = 0; i < N; ++i) numbers[i] = (*this)[i];
  }

  constexpr T& operator[](int i) { return data[static_cast<std::size_t>(i)]; }
  constexpr const T& operator[](int i) const { return data[static_cast<std::size_t>(i)]; }

  constexpr Vector& operator+=(const Vector& other) {
    for (int i = 0; i < N; ++i) (*this)[i] += other[i];
    return *this;
  }
  constexpr Vector& operator-=(const Vector& other) {
    for (int i = 0; i < N; ++i) (*this)[i] -= other[i];
    return *this;
  }
  constexpr Vector& operator*=(const T& factor) {
    for (int i = 0; i < N; ++i) (*this)[i] *= factor;
    return *this;
  }
  constexpr Vector& operator/=(const T& divisor) {
    for (int i = 0; i < N; ++i) (*this)[i] /= divisor;
    return *this;
  }

  friend constexpr Vector operator+(Vector a, const Vector& b) { return a += b; }
  friend constexpr Vector operator-(Vector a, const Vector& b) { return a -= b; }
  friend constexpr Vector operator-(const Vector& a) { return Vector{} - a; }
  friend constexpr Vector operator*(const T& factor, Vector a) { return a *= factor; }
  friend constexpr Vector operator*(Vector a, const T& factor) { return a *= factor; }
  friend constexpr Vector operator/(Vector a, const T& divisor) { return a /= divisor; }
  friend constexpr bool operator==(const Vector& a, const Vector& b) { return a.data == b.data; }
  friend constexpr bool operator!=(const Vector& a, const Vector& b) { return !(a == b); }
};

using Vector2 = Vector<2>;
using Vector3 = Vector<3>;

template <int N, class T>
constexpr T dot(const Vector<N, T>& a, const Vector<N, T>& b) {
  T sum = a[0] * b[0];
  for (int i = 1; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

template <class T>
constexpr Vector<3, T> cross(const Vector<3, T>& a, const Vector<3, T>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// The third component of the cross product of two vectors of the plane.
template <class T>
constexpr T cross(const Vector<2, T>& a, const Vector<2, T>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

template <int N, class T>
constexpr T norm_squared(const Vector<N, T>& a) {
  return dot(a, a);
}

template <int N, class T>
T norm(const Vector<N, T>& a) {
  using std::sqrt;
  return sqrt(norm_squared(a));
}

/// a/|a|; not a number for a = 0.
template <int N, class T>
Vector<N, T> normalized(const Vector<N, T>& a) {
  return a / norm(a);
}

/// R rows of C numbers, stored row by row.
template <int R, int C, class T = double>
struct Matrix {
  std::array<T, static_cast<std::size_t>(R* C)> data{};

  static constexpr int rows() noexcept { return R; }
  static constexpr int columns() noexcept { return C; }
  static constexpr Matrix zero() { return {}; }
  static constexpr Matrix identity() {
    static_assert(R == C, "only a square matrix has an identity");
    Matrix m;
    for (int i = 0; i < R; ++i) m(i, i) = T(1);
    return m;
  }
  static constexpr Matrix load(const T* numbers) {
    Matrix m;
    for (int k = 0; k < R * C; ++k) m.data[static_cast<std::size_t>(k)] = numbers[k];
    return m;
  }
  constexpr void store(T* numbers) const {
    for (int k = 0; k < R * C; ++k) numbers[k] = data[static_cast<std::size_t>(k)];
  }

  constexpr T& operator()(int i, int j) { return data[static_cast<std::size_t>(i * C + j)]; }
  constexpr const T& operator()(int i, int j) const { return data[static_cast<std::size_t>(i * C + j)]; }

  constexpr Vector<C, T> row(int i) const {
    Vector<C, T> v;
    for (int j = 0; j < C; ++j) v[j] = (*this)(i, j);
    return v;
  }
  constexpr Vector<R, T> column(int j) const {
    Vector<R, T> v;
    for (int i = 0; i < R; ++i) v[i] = (*this)(i, j);
    return v;
  }
  constexpr void set_column(int j, const Vector<R, T>& v) {
    for (int i = 0; i < R; ++i) (*this)(i, j) = v[i];
  }
  /// The P × Q block whose first entry is (i, j).
  template <int P, int Q>
  constexpr Matrix<P, Q, T> block(int i, int j) const {
    Matrix<P, Q, T> b;
    for (int p = 0; p < P; ++p) {
      for (int q = 0; q < Q; ++q) b(p, q) = (*this)(i + p, j + q);
    }
    return b;
  }
  template <int P, int Q>
  constexpr void set_block(int i, int j, const Matrix<P, Q, T>& b) {
    for (int p = 0; p < P; ++p) {
      for (int q = 0; q < Q; ++q) (*this)(i + p, j + q) = b(p, q);
    }
  }
  constexpr Matrix<C, R, T> transpose() const {
    Matrix<C, R, T> m;
    for (int i = 0; i < R; ++i) {
      for (int j = 0; j < C; ++j) m(j, i) = (*this)(i, j);
    }
    return m;
  }

  constexpr Matrix& operator+=(const Matrix& other) {
    for (std::size_t k = 0; k < data.size(); ++k) data[k] += other.data[k];
    return *this;
  }
  constexpr Matrix& operator-=(const Matrix& other) {
    for (std::size_t k = 0; k < data.size(); ++k) data[k] -= other.data[k];
    return *this;
  }
  constexpr Matrix& operator*=(const T& factor) {
    for (std::size_t k = 0; k < data.size(); ++k) data[k] *= factor;
    return *this;
  }
  constexpr Matrix& operator/=(const T& divisor) {
    for (std::size_t k = 0; k < data.size(); ++k) data[k] /= divisor;
    return *this;
  }

  friend constexpr Matrix operator+(Matrix a, const Matrix& b) { return a += b; }
  friend constexpr Matrix operator-(Matrix a, const Matrix& b) { return a -= b; }
  friend constexpr Matrix operator-(const Matrix& a) { return Matrix{} - a; }
  friend constexpr Matrix operator*(const T& factor, Matrix a) { return a *= factor; }
  friend constexpr Matrix operator*(Matrix a, const T& factor) { return a *= factor; }
  friend constexpr Matrix operator/(Matrix a, const T& divisor) { return a /= divisor; }
  friend constexpr bool operator==(const Matrix& a, const Matrix& b) { return a.data == b.data; }
  friend constexpr bool operator!=(const Matrix& a, const Matrix& b) { return !(a == b); }
};

using Matrix2 = Matrix<2, 2>;
using Matrix3 = Matrix<3, 3>;

template <int R, int K, int C, class T>
constexpr Matrix<R, C, T> operator*(const Matrix<R, K, T>& a, const Matrix<K, C, T>& b) {
  Matrix<R, C, T> product;
  for (int i = 0; i < R; ++i) {
    for (int k = 0; k < K; ++k) {
      for (int j = 0; j < C; ++j) product(i, j) += a(i, k) * b(k, j);
    }
  }
  return product;
}

template <int R, int C, class T>
constexpr Vector<R, T> operator*(const Matrix<R, C, T>& a, const Vector<C, T>& v) {
  Vector<R, T> product;
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < C; ++j) product[i] += a(i, j) * v[j];
  }
  return product;
}

/// a bᵀ
template <int R, int C, class T>
constexpr Matrix<R, C, T> outer(const Vector<R, T>& a, const Vector<C, T>& b) {
  Matrix<R, C, T> m;
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < C; ++j) m(i, j) = a[i] * b[j];
  }
  return m;
}

/// ½(m + mᵀ)
template <int N, class T>
constexpr Matrix<N, N, T> symmetric_part(const Matrix<N, N, T>& m) {
  return (m + m.transpose()) * T(0.5);
}

/// The skew matrix with hat(v) x = v × x.
template <class T>
constexpr Matrix<3, 3, T> hat(const Vector<3, T>& v) {
  Matrix<3, 3, T> m;
  m(0, 1) = -v[2];
  m(0, 2) = v[1];
  m(1, 0) = v[2];
  m(1, 2) = -v[0];
  m(2, 0) = -v[1];
  m(2, 1) = v[0];
  return m;
}

/// The inverse of `hat`, of the skew part of m.
template <class T>
constexpr Vector<3, T> vee(const Matrix<3, 3, T>& m) {
  return Vector<3, T>{{m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)}} * T(0.5);
}

}  // namespace bowstring
