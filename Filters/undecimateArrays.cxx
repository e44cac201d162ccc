// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateArrays.h"

#include "fingerprint.h"
#include "undecimateMemory.h"

#include "vtkBitArray.h"
#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkLookupTable.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <type_traits>

#ifdef __x86_64__
#include <emmintrin.h>
#endif

namespace undecimate
{
namespace filters
{

namespace
{

// Arrays that are much larger than this are in no cache when they have been written.
constexpr std::size_t kCacheBytes = 4 << 20;

// Whether the values are plain numbers in one block of memory, tuple after tuple.
bool isBlock(vtkAbstractArray* array)
{
  return vtkDataArray::SafeDownCast(array) != nullptr && array->HasStandardMemoryLayout() &&
    array->GetDataType() != VTK_BIT;
}

std::size_t tupleBytes(vtkAbstractArray* array)
{
  return static_cast<std::size_t>(array->GetDataTypeSize()) * array->GetNumberOfComponents();
}

char* bytes(vtkAbstractArray* array)
{
  return static_cast<char*>(array->GetVoidPointer(0));
}

// The loops over tuples, with the tuple's size known to the compiler: copying is then a few moves.
template <std::size_t Size>
struct FixedSize
{
  static constexpr std::size_t value() { return Size; }
};

struct AnySize
{
  std::size_t size;
  std::size_t value() const { return this->size; }
};

template <class Work>
void dispatchSize(std::size_t size, Work&& work)
{
  switch (size)
  {
    case 1:
      return work(FixedSize<1>());
    case 2:
      return work(FixedSize<2>());
    case 4:
      return work(FixedSize<4>());
    case 8:
      return work(FixedSize<8>());
    case 12:
      return work(FixedSize<12>());
    case 16:
      return work(FixedSize<16>());
    case 24:
      return work(FixedSize<24>());
    case 36:
      return work(FixedSize<36>());
    case 48:
      return work(FixedSize<48>());
    case 72:
      return work(FixedSize<72>());
    default:
      return work(AnySize{ size });
  }
}

void gatherBlock(
  char* to, const char* from, std::size_t size, const Index* numbers, vtkIdType count)
{
  dispatchSize(size,
    [=](auto fixed)
    {
      for (vtkIdType i = 0; i < count; ++i)
      {
        std::memcpy(to + fixed.value() * i, from + fixed.value() * numbers[i], fixed.value());
      }
    });
}

void scatterBlock(
  char* to, const char* from, std::size_t size, const Index* places, vtkIdType count)
{
  dispatchSize(size,
    [=](auto fixed)
    {
      for (vtkIdType i = 0; i < count; ++i)
      {
        std::memcpy(to + fixed.value() * places[i], from + fixed.value() * i, fixed.value());
      }
    });
}

// Tuples of one array for places of another: numbers first, first + 1, ..., or first + numbers[i].
struct Tuples
{
  vtkIdType first = 0;
  const Index* numbers = nullptr;

  vtkIdType operator[](vtkIdType i) const
  {
    return this->first + (this->numbers ? this->numbers[i] : i);
  }
};

// For arrays that only VTK knows how to copy. With lists of numbers, for the InsertTuples() that
// takes ranges writes structures of arrays to wrong places (VTK 9.2).
void copyTuples(
  vtkAbstractArray* to, Tuples places, vtkAbstractArray* from, Tuples numbers, vtkIdType count)
{
  if (count == 0)
  {
    return;
  }
  vtkNew<vtkIdList> toIds;
  vtkNew<vtkIdList> fromIds;
  toIds->SetNumberOfIds(count);
  fromIds->SetNumberOfIds(count);
  vtkIdType* toId = toIds->GetPointer(0);
  vtkIdType* fromId = fromIds->GetPointer(0);
  for (vtkIdType i = 0; i < count; ++i)
  {
    toId[i] = places[i];
    fromId[i] = numbers[i];
  }
  to->InsertTuples(toIds, fromIds, from);
}

// Run work(offsets, connectivity, connectivity's length) on the arrays of a cell array.
template <class Work>
void visitCells(vtkCellArray* cells, Work&& work)
{
  if (cells->IsStorage64Bit())
  {
    work(cells->GetOffsetsArray64()->GetPointer(0), cells->GetConnectivityArray64()->GetPointer(0),
      cells->GetConnectivityArray64()->GetNumberOfValues());
  }
  else
  {
    work(cells->GetOffsetsArray32()->GetPointer(0), cells->GetConnectivityArray32()->GetPointer(0),
      cells->GetConnectivityArray32()->GetNumberOfValues());
  }
}

// Give an array room for its tuples.
void setTuples(vtkAbstractArray* array, vtkIdType tuples, ArrayMemory* memory)
{
  if (memory && isBlock(array))
  {
    memory->allocate(array, tuples);
  }
  else
  {
    array->SetNumberOfTuples(tuples);
  }
  if (array->GetNumberOfTuples() != tuples)
  {
    throw std::bad_alloc();
  }
}

template <class ArrayType>
typename ArrayType::ValueType* resize(ArrayType* array, vtkIdType values, ArrayMemory* memory)
{
  setTuples(array, values, memory);
  return array->GetPointer(0);
}

// Write to[0], to[1], ... = value(0), value(1), ... as memcpy() does it when the array is large:
// past the caches. It would not fit, and to read lines only to overwrite them takes half as long
// again.
template <class Value, class Function>
void writeOnce(Value* to, vtkIdType count, const Function& value)
{
#ifdef __x86_64__
  if (count * sizeof(Value) > kCacheBytes)
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      if constexpr (sizeof(Value) == sizeof(long long))
      {
        _mm_stream_si64(reinterpret_cast<long long*>(to + i), value(i));
      }
      else
      {
        _mm_stream_si32(reinterpret_cast<int*>(to + i), value(i));
      }
    }
    _mm_sfence();
    return;
  }
#endif
  for (vtkIdType i = 0; i < count; ++i)
  {
    to[i] = value(i);
  }
}

template <class ArrayType>
void fillTriangles(vtkCellArray* cells, const Index* corners, vtkIdType count, ArrayMemory* memory)
{
  using Value = typename ArrayType::ValueType;
  vtkNew<ArrayType> offsets;
  vtkNew<ArrayType> connectivity;
  writeOnce(resize(offsets.Get(), count + 1, memory), count + 1,
    [](vtkIdType i) { return static_cast<Value>(3 * i); });
  Value* corner = resize(connectivity.Get(), 3 * count, memory);
  if constexpr (sizeof(Value) == sizeof(Index))
  {
    std::copy_n(corners, 3 * count, corner);
  }
  else
  {
    writeOnce(corner, 3 * count, [corners](vtkIdType i) { return Value{ corners[i] }; });
  }
  cells->SetData(offsets.Get(), connectivity.Get());
}

// Of triangles and quads: four corners a cell, kNone at the last of triangles.
template <class ArrayType>
void fillFaces(
  vtkCellArray* cells, const Index* corners, vtkIdType count, vtkIdType quads, ArrayMemory* memory)
{
  using Value = typename ArrayType::ValueType;
  vtkNew<ArrayType> offsets;
  vtkNew<ArrayType> connectivity;
  Value* offset = resize(offsets.Get(), count + 1, memory);
  Value* first = resize(connectivity.Get(), 3 * count + quads, memory);
  Value* corner = first;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    const Index* from = corners + 4 * cell;
    offset[cell] = static_cast<Value>(corner - first);
    *corner++ = from[0];
    *corner++ = from[1];
    *corner++ = from[2];
    if (from[3] != kNone)
    {
      *corner++ = from[3];
    }
  }
  offset[count] = static_cast<Value>(corner - first);
  cells->SetData(offsets.Get(), connectivity.Get());
}

template <class ArrayType, class Offset>
void fillMapped(vtkCellArray* cells, const Offset* offsets, const Offset* connectivity,
  vtkIdType count, const Index* map)
{
  using Value = typename ArrayType::ValueType;
  vtkNew<ArrayType> newOffsets;
  vtkNew<ArrayType> newConnectivity;
  Value* offset = resize(newOffsets.Get(), count + 1, nullptr);
  std::transform(
    offsets, offsets + count + 1, offset, [](Offset o) { return static_cast<Value>(o); });
  const vtkIdType size = static_cast<vtkIdType>(offsets[count]);
  Value* corner = resize(newConnectivity.Get(), size, nullptr);
  std::transform(connectivity, connectivity + size, corner, [map](Offset p) { return map[p]; });
  cells->SetData(newOffsets.Get(), newConnectivity.Get());
}

// Kind of number and its size: what a file keeps of a type.
std::int64_t typeCode(vtkAbstractArray* array)
{
  char kind = 'u';
  switch (array->GetDataType())
  {
    case VTK_FLOAT:
    case VTK_DOUBLE:
      kind = 'f';
      break;
    case VTK_CHAR:
      kind = std::is_signed<char>::value ? 'i' : 'u';
      break;
    case VTK_SIGNED_CHAR:
    case VTK_SHORT:
    case VTK_INT:
    case VTK_LONG:
    case VTK_LONG_LONG:
    case VTK_ID_TYPE:
      kind = 'i';
      break;
    default:
      break;
  }
  return 256 * static_cast<std::int64_t>(kind) + array->GetDataTypeSize();
}

void addStrings(Fingerprint& print, vtkStringArray* array)
{
  print.add(std::int64_t{ 's' });
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    print.add(array->GetValue(i));
  }
}

void addBits(Fingerprint& print, vtkBitArray* array)
{
  print.add(std::int64_t{ 'b' });
  std::vector<unsigned char> values(array->GetNumberOfValues());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = array->GetValue(static_cast<vtkIdType>(i)) != 0;
  }
  print.add(values.data(), values.size());
}

void addVariants(Fingerprint& print, vtkAbstractArray* array)
{
  print.add(std::string(array->GetClassName()));
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    const vtkVariant value = array->GetVariantValue(i);
    print.add(std::string(value.GetTypeAsString()));
    if (value.IsFloat() || value.IsDouble())
    {
      const double number = value.ToDouble(); // as text it would lose digits
      print.add(&number, sizeof(number));
    }
    else
    {
      print.add(std::string(value.ToString()));
    }
  }
}

void addNumbers(Fingerprint& print, vtkDataArray* array)
{
  print.add(typeCode(array));
  vtkSmartPointer<vtkDataArray> block = array;
  if (!isBlock(array))
  {
    block =
      vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array->GetDataType()));
    block->DeepCopy(array);
  }
  print.add(bytes(block), tupleBytes(block) * block->GetNumberOfTuples());
}

// All about an array but type, components and values.
void describe(vtkAbstractArray* array, vtkAbstractArray* like)
{
  array->SetName(like->GetName());
  array->SetNumberOfComponents(like->GetNumberOfComponents());
  array->CopyComponentNames(like);
  // Made now, for an array that gets its information later (at the first GetRange()) counts as
  // modified, and everything downstream would run again.
  array->GetInformation();
  if (like->HasInformation())
  {
    array->CopyInformation(like->GetInformation(), /*deep=*/1);
  }
  vtkDataArray* numbers = vtkDataArray::SafeDownCast(like);
  if (numbers && numbers->GetLookupTable())
  {
    vtkDataArray::SafeDownCast(array)->SetLookupTable(numbers->GetLookupTable());
  }
  array->Modified(); // forgets the ranges that came with the information
}

} // namespace

ArrayPointer newLike(vtkAbstractArray* like, vtkIdType tuples, ArrayMemory* memory)
{
  const bool writable = !vtkDataArray::SafeDownCast(like) || isBlock(like) ||
    like->GetDataType() == VTK_BIT ||
    like->GetArrayType() == vtkAbstractArray::SoADataArrayTemplate;
  ArrayPointer array = ArrayPointer::Take(
    writable ? like->NewInstance() : vtkAbstractArray::CreateArray(like->GetDataType()));
  describe(array, like);
  setTuples(array, tuples, memory);
  return array;
}

ArrayPointer share(vtkAbstractArray* values, vtkAbstractArray* like)
{
  ArrayPointer array;
  if (isBlock(values))
  {
    array = ArrayPointer::Take(values->NewInstance());
    vtkDataArray::SafeDownCast(array)->ShallowCopy(vtkDataArray::SafeDownCast(values));
  }
  else
  {
    array = join(values, values->GetNumberOfTuples(), nullptr, 0);
  }
  describe(array, like);
  return array;
}

ArrayPointer gather(vtkAbstractArray* from, vtkAbstractArray* like, vtkIdType leading,
  const Index* numbers, vtkIdType count, ArrayMemory* memory, Threads* threads)
{
  ArrayPointer to = newLike(like, leading + count, memory);
  if (isBlock(from) && isBlock(to))
  {
    const std::size_t size = tupleBytes(from);
    if (leading > 0)
    {
      std::memcpy(bytes(to), bytes(from), size * leading);
    }
    const char* source = bytes(from) + size * leading;
    char* goal = bytes(to) + size * leading;
    doInShares(threads, static_cast<Index>(count),
      [=](const Share& share)
      {
        gatherBlock(
          goal + size * share.begin, source, size, numbers + share.begin, share.end - share.begin);
      });
    return to;
  }
  copyTuples(to, {}, from, {}, leading);
  copyTuples(to, { leading }, from, { leading, numbers }, count);
  return to;
}

ArrayPointer join(vtkAbstractArray* base, vtkIdType baseCount, vtkAbstractArray* rest,
  vtkIdType restCount, ArrayMemory* memory)
{
  ArrayPointer to = newLike(base, baseCount + restCount, memory);
  if (isBlock(base) && isBlock(to) && (restCount == 0 || isBlock(rest)))
  {
    const std::size_t size = tupleBytes(base);
    if (baseCount > 0)
    {
      std::memcpy(bytes(to), bytes(base), size * baseCount);
    }
    if (restCount > 0)
    {
      std::memcpy(bytes(to) + size * baseCount, bytes(rest), size * restCount);
    }
    return to;
  }
  copyTuples(to, {}, base, {}, baseCount);
  copyTuples(to, { baseCount }, rest, {}, restCount);
  return to;
}

ArrayPointer scatter(vtkAbstractArray* base, vtkIdType baseCount, vtkAbstractArray* rest,
  vtkIdType restCount, const Index* order)
{
  ArrayPointer to = newLike(base, baseCount + restCount, nullptr);
  if (isBlock(base) && isBlock(to) && (restCount == 0 || isBlock(rest)))
  {
    const std::size_t size = tupleBytes(base);
    scatterBlock(bytes(to), bytes(base), size, order, baseCount);
    if (restCount > 0)
    {
      scatterBlock(bytes(to), bytes(rest), size, order + baseCount, restCount);
    }
    return to;
  }
  copyTuples(to, { 0, order }, base, {}, baseCount);
  copyTuples(to, { 0, order + baseCount }, rest, {}, restCount);
  return to;
}

void setArrays(
  vtkDataSetAttributes* to, vtkDataSetAttributes* from, const std::vector<ArrayPointer>& arrays)
{
  int active[vtkDataSetAttributes::NUM_ATTRIBUTES];
  from->GetAttributeIndices(active);
  for (std::size_t i = 0; i < arrays.size(); ++i)
  {
    if (!arrays[i])
    {
      continue;
    }
    const int place = to->AddArray(arrays[i]);
    for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute)
    {
      if (active[attribute] == static_cast<int>(i))
      {
        to->SetActiveAttribute(place, attribute);
      }
    }
  }
}

std::uint64_t fingerprint(vtkAbstractArray* array)
{
  Fingerprint print;
  print.add(std::int64_t{ array->GetNumberOfComponents() });
  print.add(static_cast<std::int64_t>(array->GetNumberOfTuples()));
  if (auto* strings = vtkStringArray::SafeDownCast(array))
  {
    addStrings(print, strings);
  }
  else if (auto* bits = vtkBitArray::SafeDownCast(array))
  {
    addBits(print, bits);
  }
  else if (auto* numbers = vtkDataArray::SafeDownCast(array))
  {
    addNumbers(print, numbers);
  }
  else
  {
    addVariants(print, array);
  }
  return print.value();
}

std::string typeName(vtkAbstractArray* array)
{
  return vtkDataArray::SafeDownCast(array) ? array->GetDataTypeAsString() : array->GetClassName();
}

std::string listNames(vtkFieldData* arrays)
{
  std::string names;
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    const char* name = arrays->GetAbstractArray(i)->GetName();
    if (name)
    {
      names += (names.empty() ? "'" : ", '") + std::string(name) + "'";
    }
  }
  return names.empty() ? "none" : names;
}

FaceCells readFaces(vtkCellArray* cells, vtkIdType pointCount, int cornersPerCell)
{
  FaceCells result;
  const vtkIdType count = cells->GetNumberOfCells();
  if (count == 0)
  {
    return result;
  }
  result.corners.resize(static_cast<std::size_t>(cornersPerCell) * count, kNone);
  visitCells(cells,
    [&](const auto* offsets, const auto* connectivity, vtkIdType size)
    {
      for (vtkIdType cell = 0; cell < count; ++cell)
      {
        const vtkIdType begin = offsets[cell];
        const vtkIdType end = offsets[cell + 1];
        if (begin < 0 || end < begin || end > size)
        {
          result.badCell = cell;
          result.badPoint = end;
          return;
        }
        const bool fits = end - begin == 3 || end - begin == cornersPerCell;
        result.otherCells += !fits;
        Index* corner = result.corners.data() + cornersPerCell * cell;
        for (vtkIdType i = begin; i < end; ++i)
        {
          const vtkIdType point = connectivity[i];
          if (point < 0 || point >= pointCount)
          {
            result.badCell = cell;
            result.badPoint = point;
            return;
          }
          if (fits)
          {
            *corner++ = static_cast<Index>(point);
          }
        }
      }
    });
  return result;
}

TriangleCorners trianglesInPlace(vtkCellArray* cells)
{
  TriangleCorners corners;
  const vtkIdType count = cells->GetNumberOfCells();
  if (count == 0)
  {
    return corners;
  }
  visitCells(cells,
    [&](const auto* offsets, const auto* connectivity, vtkIdType size)
    {
      vtkIdType others = 0;
      for (vtkIdType cell = 0; cell <= count; ++cell)
      {
        others += offsets[cell] != 3 * cell ? 1 : 0;
      }
      if (others > 0 || size < 3 * count)
      {
        return;
      }
      using Number = std::decay_t<decltype(*connectivity)>;
      if constexpr (sizeof(Number) == sizeof(std::int64_t))
      {
        corners.wide = reinterpret_cast<const std::int64_t*>(connectivity);
      }
      else
      {
        corners.narrow = reinterpret_cast<const std::int32_t*>(connectivity);
      }
    });
  return corners;
}

vtkSmartPointer<vtkCellArray> makeFaces(const Index* corners, int cornersPerCell, vtkIdType count,
  bool wide, ArrayMemory* memory, vtkIdType& quads)
{
  quads = 0;
  for (vtkIdType cell = 0; cornersPerCell == 4 && cell < count; ++cell)
  {
    quads += corners[4 * cell + 3] != kNone;
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  const auto fill = [&](auto* type)
  {
    using ArrayType = std::remove_pointer_t<decltype(type)>;
    if (cornersPerCell == 3)
    {
      fillTriangles<ArrayType>(cells, corners, count, memory);
    }
    else
    {
      fillFaces<ArrayType>(cells, corners, count, quads, memory);
    }
  };
  if (wide)
  {
    fill(static_cast<vtkCellArray::ArrayType64*>(nullptr));
  }
  else
  {
    fill(static_cast<vtkCellArray::ArrayType32*>(nullptr));
  }
  return cells;
}

vtkSmartPointer<vtkCellArray> mapPoints(vtkCellArray* cells, const Index* map, bool wide)
{
  auto mapped = vtkSmartPointer<vtkCellArray>::New();
  const vtkIdType count = cells->GetNumberOfCells();
  visitCells(cells,
    [&](const auto* offsets, const auto* connectivity, vtkIdType)
    {
      if (wide)
      {
        fillMapped<vtkCellArray::ArrayType64>(mapped, offsets, connectivity, count, map);
      }
      else
      {
        fillMapped<vtkCellArray::ArrayType32>(mapped, offsets, connectivity, count, map);
      }
    });
  return mapped;
}

bool flagPoints(
  vtkCellArray* cells, std::vector<unsigned char>& flags, const unsigned char* cellFlags)
{
  bool good = true;
  const vtkIdType count = cells->GetNumberOfCells();
  if (count == 0)
  {
    return good;
  }
  visitCells(cells,
    [&](const auto* offsets, const auto* connectivity, vtkIdType size)
    {
      for (vtkIdType cell = 0; good && cell < count; ++cell)
      {
        const unsigned char flag = cellFlags ? cellFlags[cell] : 1;
        const vtkIdType end = offsets[cell + 1];
        good = offsets[cell] >= 0 && end <= size;
        for (vtkIdType i = offsets[cell]; good && i < end; ++i)
        {
          const vtkIdType point = connectivity[i];
          good = point >= 0 && point < static_cast<vtkIdType>(flags.size());
          if (good)
          {
            flags[point] |= flag;
          }
        }
      }
    });
  return good;
}

std::uint64_t fingerprint(vtkCellArray* cells)
{
  Fingerprint print;
  const vtkIdType count = cells->GetNumberOfCells();
  print.add(static_cast<std::int64_t>(count));
  if (count == 0)
  {
    return print.value();
  }
  visitCells(cells,
    [&](const auto* offsets, const auto* connectivity, vtkIdType size)
    {
      std::int64_t block[1024];
      const auto add = [&](const auto* values, vtkIdType number)
      {
        for (vtkIdType done = 0; done < number; done += 1024)
        {
          const vtkIdType part = std::min<vtkIdType>(1024, number - done);
          std::copy_n(values + done, part, block);
          print.add(block, part * sizeof(block[0]));
        }
      };
      add(offsets, count + 1);
      add(connectivity, std::clamp<vtkIdType>(offsets[count], 0, size));
    });
  return print.value();
}

} // namespace filters
} // namespace undecimate
