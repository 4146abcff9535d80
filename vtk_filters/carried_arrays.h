#ifndef carried_arrays_h
#define carried_arrays_h

#include <symsurf/attributes.h>

#include <map>
#include <string>
#include <vector>

class vtkDataSetAttributes;

/// Makes the data that of the rows of another's.
void copy_rows(vtkDataSetAttributes* to, vtkDataSetAttributes* from,
               const std::vector<symsurf::Index>& rows);

using KindsByName = std::map<std::string, symsurf::AttributeKind>;

/// What "wind=vector,stress=tensor" says of arrays of the data. Throws InvalidParameter.
KindsByName kinds_of(const std::string& text, vtkDataSetAttributes* data);

/// Gives data that have the arrays of another's, each at the same place, the values that the
/// transform makes of these: of active vectors, normals and tensors, of those that `kinds`
/// names and, with `blends`, of real numbers and colours. Arrays that both share stay as they are
/// in the other.
void carry_values(vtkDataSetAttributes* to, vtkDataSetAttributes* from,
                  const symsurf::AttributeTransform& by, bool blends,
                  const KindsByName& kinds = {});

#endif
