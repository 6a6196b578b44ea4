#pragma once
/// A sparse matrix as plain lists that kernels in lanes read.

namespace noether {

/// Row k has the elements value[e] in columns column[e], e from row[k] to row[k + 1] - 1.
struct PreconditionerLists {
  const int *row, *column;
  const double* value;
};

}  // namespace noether
