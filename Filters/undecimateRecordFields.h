// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// clang-format off
/// @file undecimateRecordFields.h
/// @brief How a record travels: as field data arrays of the coarse mesh.
///
/// All names start with "Undecimation."; arrays without a value are left out. Numbers of nodes and
/// cells are in record order (record.h) unless stated otherwise.
///
/// | name               | type            | values |
/// | ------------------ | --------------- | ------ |
/// | .Header            | int64           | see HeaderField |
/// | .NodeOrder         | int32           | a node: its original number |
/// | .CellOrder         | int32           | a triangle slot: its original number among the triangles (version 3: without sources only) |
/// | .StepErrors        | float           | a step: error before it is undone |
/// | .StepHoles         | unsigned char   | a step: its hole (version 3, as .HoleCodes) |
/// | .HoleCodes         | unsigned char   | the codes of the steps |
/// | .Patches           | int32           | slots and listed nodes, step after step (versions 1 and 2, as the next three) |
/// | .StepShapes        | int32           | a step: its shape |
/// | .ShapeOffsets      | int32           | where each shape starts in .Shapes, and the end |
/// | .Shapes            | unsigned char   | the shapes |
/// | .BaseSources       | int32           | a triangle of the coarse mesh: original triangle shown |
/// | .LostSources       | unsigned char   | codes of what old cells without heir show (version 1: int32, original triangles) |
/// | .Points            | as the points   | x, y, z of a removed node |
/// | .PointData.i       | as the array    | values of point array i at a removed node |
/// | .CellData.i        | as the array    | all values of cell array i, in original order |
/// | .ArrayNames        | string          | "point:" or "cell:" and the name (may be empty) |
/// | .ArrayFingerprints | int64           | one for each name: of the coarse mesh's array |
///
/// The types are those that VTK's XML files keep.
// clang-format on

#ifndef undecimateRecordFields_h
#define undecimateRecordFields_h

#include "undecimateArrays.h"

#include "monitor.h"
#include "record.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

class vtkPolyData;

namespace undecimate
{

namespace filters
{

/// Newest format version, in which meshes of triangles are written: the steps have codes. Meshes of
/// triangles and quads are written in version 2: shapes, and four corners a cell. Version 1, of
/// earlier releases, has shapes and three corners.
constexpr std::int64_t kRecordVersion = 3;

/// Entries of the array .Header.
enum HeaderField
{
  kVersion = 0,         ///< 1 to 3, see kRecordVersion; always the first entry
  kNodeCount,           ///< of level 1
  kCellCount,           ///< triangles (and quads) of level 1
  kBaseNodeCount,       ///< of level 0
  kBaseCellCount,       ///< triangles (and quads) of level 0
  kFormCount,           ///< shapes; in version 3 bytes of .HoleCodes
  kPatchSize,           ///< values of .Patches, in version 3 0
  kLostSourceSize,      ///< values of .LostSources
  kCornersPerCell,      ///< 3, in version 2 also 4
  kHasSources,          ///< 1 if sources are recorded (there is cell data)
  kVertCount,           ///< vertex cells, the same at all levels
  kLineCount,           ///< line cells, the same at all levels
  kWideVerts,           ///< 1 if the input's vertex cells are stored in 64 bits, 0 if in 32
  kWideLines,           ///< the same for lines
  kWidePolys,           ///< the same for triangles
  kPointArrayCount,     ///< point arrays of the input
  kCellArrayCount,      ///< cell arrays of the input
  kHasOriginalPointIds, ///< 1 if the decimation added the array vtkOriginalPointIds
  kPointsFingerprint,   ///< of the coarse mesh's points
  kCellsFingerprint,    ///< of the coarse mesh's vertex cells, lines and triangles
  kChecksum,            ///< of all entries above and all other arrays
  kHeaderSize
};

/// Name of the array of original point numbers, on request in both filters.
constexpr const char* kOriginalPointIds = "vtkOriginalPointIds";

/// Whether a field data array belongs to a record.
bool isRecordArray(const char* name);

/// Give `to` all arrays of `from` but those of a record, and no others.
void passFieldData(vtkFieldData* from, vtkFieldData* to);

/// Pass on a mesh without points and cells, without a record. False if it is not empty.
bool passEmpty(vtkPolyData* from, vtkPolyData* to);

/// Fingerprints of arrays that do not change, by the array and its time: hashing a record anew for
/// each time step would take as long as handing out the mesh. The arrays must outlive their use.
using KnownFingerprints = std::map<const vtkAbstractArray*, std::pair<vtkMTimeType, std::int64_t>>;

/// Hash of a header (up to kChecksum) and of the record's other arrays, by name.
/// @param known fingerprints that need not be computed; or null
std::int64_t recordChecksum(
  const std::int64_t* header, vtkFieldData* fields, const KnownFingerprints* known = nullptr);

/// The arrays of a record, which say nothing of places and values: meshes that differ in nothing
/// else (time steps) share them.
class RecordArrays
{
public:
  RecordArrays() = default;

  /// @param record its arrays are freed as they are written
  /// @param threads to share the work out among, or null
  explicit RecordArrays(Record& record, Threads* threads = nullptr);

  /// Add the record to the field data of a coarse mesh.
  /// @param mesh the input of the decimation
  /// @param coarse its output: points, cells, point and cell data, complete
  /// @param hasOriginalPointIds the last point array of `coarse` is kOriginalPointIds, added to
  /// mesh's
  /// @param threads as above
  void addTo(vtkPolyData* mesh, vtkPolyData* coarse, bool hasOriginalPointIds,
    Threads* threads = nullptr) const;

private:
  std::int64_t header_[kHeaderSize] = {};
  vtkSmartPointer<vtkFieldData> fields_;
  KnownFingerprints known_;
};

/// RecordArrays(record, threads).addTo(mesh, coarse, hasOriginalPointIds, threads), for a mesh
/// without time.
void writeRecord(Record& record, vtkPolyData* mesh, vtkPolyData* coarse, bool hasOriginalPointIds,
  Threads* threads = nullptr);

/// A record as it was found in the field data of a mesh. Keeps the arrays alive.
struct RecordFields
{
  RecordView view;
  std::int64_t header[kHeaderSize] = {};
  std::vector<Index> baseCells;        ///< of the mesh that was read, header[kCornersPerCell] each
  ArrayPointer points;                 ///< of the removed nodes; null if there are none
  std::vector<int> pointArrays;        ///< number of each point array in the mesh that was read
  std::vector<ArrayPointer> pointData; ///< its values at the removed nodes; null if there are none
  std::vector<int> cellArrays;         ///< number of each cell array in the mesh that was read
  std::vector<ArrayPointer> cellData;  ///< its values at level 1; null if there are no cells
  std::vector<ArrayPointer> kept;      ///< the arrays that `view` points into
  std::vector<vtkMTimeType> keptTimes; ///< of those of the record itself
};

/// Find the record in a mesh's field data, and check that it is whole and belongs to the mesh as it
/// is. What the record itself says is checked by Undecimation::open().
/// @param[out] fields complete if nothing is wrong and `monitor` did not cancel
/// @param monitor progress and cancel; asked after each array
/// @param known fingerprints that need not be computed; or null
/// @return what is wrong and what to do, or an empty string
/// Complexity: O(mesh + record).
std::string readRecord(vtkPolyData* mesh, RecordFields& fields, Monitor& monitor,
  const KnownFingerprints* known = nullptr);

/// Whether two records have the same arrays but for places and values, as they share them.
bool shareRecordArrays(const RecordFields& a, const RecordFields& b);

/// The fingerprints of a record's arrays that do not change with time.
KnownFingerprints knownFingerprints(const RecordFields& fields);

} // namespace filters
} // namespace undecimate

#endif
