#pragma once
/// Which columns the parts of a scene give to its particles.

#include "scene/parts.hpp"
#include "scene/reader.hpp"

#include <vector>

namespace noether {

/// The columns that the Hamiltonian and the forces of a scene declare. What is wrong with these is told later, when
/// they are read. @throws SceneError  where two parts mean different columns by one name
std::vector<ColumnInfo> declared_columns(const SceneContext& context, const Parts& parts,
                                         const SceneValue& hamiltonian);

/// The columns of parts that the scene does not have.
std::vector<ColumnInfo> columns_of_other_parts(const Parts& parts, const std::vector<ColumnInfo>& declared);

}  // namespace noether
