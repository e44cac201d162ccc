// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

// ArrayMemory: used again when it is free, never while somebody has it.

#include "undecimateMemory.h"

#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

using undecimate::filters::ArrayMemory;

namespace
{

constexpr vtkIdType kTuples = 100000;

vtkSmartPointer<vtkDoubleArray> makeArray(ArrayMemory& memory, vtkIdType tuples, double value)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfComponents(3);
  memory.allocate(array, tuples);
  EXPECT_EQ(array->GetNumberOfTuples(), tuples);
  EXPECT_EQ(array->GetNumberOfComponents(), 3);
  std::fill_n(array->GetPointer(0), array->GetNumberOfValues(), value);
  return array;
}

bool holds(vtkDoubleArray* array, double value)
{
  const double* values = array->GetPointer(0);
  return std::all_of(
    values, values + array->GetNumberOfValues(), [value](double v) { return v == value; });
}

TEST(ArrayMemory, IsUsedAgainForArraysOfNearlyTheSize)
{
  ArrayMemory memory;
  vtkSmartPointer<vtkDoubleArray> array = makeArray(memory, kTuples, 1.0);
  const double* first = array->GetPointer(0);
  EXPECT_EQ(memory.idleBytes(), 0u);
  array = nullptr;
  EXPECT_GE(memory.idleBytes(), 24u * kTuples);
  array = makeArray(memory, kTuples + kTuples / 100, 2.0);
  EXPECT_EQ(array->GetPointer(0), first);
  EXPECT_EQ(memory.idleBytes(), 0u);
  array = nullptr;
  array = makeArray(memory, kTuples / 10, 3.0);
  EXPECT_NE(array->GetPointer(0), first) << "too large for it";
}

TEST(ArrayMemory, IsNotUsedAgainWhileSharedByAnotherArray)
{
  ArrayMemory memory;
  vtkSmartPointer<vtkDoubleArray> array = makeArray(memory, kTuples, 1.0);
  vtkNew<vtkDoubleArray> shares;
  shares->ShallowCopy(array);
  ASSERT_EQ(shares->GetPointer(0), array->GetPointer(0));
  array = nullptr;
  EXPECT_EQ(memory.idleBytes(), 0u);
  vtkSmartPointer<vtkDoubleArray> other = makeArray(memory, kTuples, 2.0);
  EXPECT_TRUE(holds(shares, 1.0));
}

TEST(ArrayMemory, MayGrowInTheHandsOfAnother)
{
  ArrayMemory memory;
  vtkSmartPointer<vtkDoubleArray> array = makeArray(memory, kTuples, 1.0);
  array->InsertNextTuple3(1.0, 1.0, 1.0);
  EXPECT_EQ(array->GetNumberOfTuples(), kTuples + 1);
  EXPECT_TRUE(holds(array, 1.0));
  EXPECT_GT(memory.idleBytes(), 0u) << "the first memory came back";
}

TEST(ArrayMemory, OutlivesItsOwner)
{
  auto memory = std::make_unique<ArrayMemory>();
  vtkSmartPointer<vtkDoubleArray> array = makeArray(*memory, kTuples, 4.0);
  vtkSmartPointer<vtkDoubleArray> gone = makeArray(*memory, kTuples, 5.0);
  gone = nullptr;
  memory = nullptr;
  EXPECT_TRUE(holds(array, 4.0));
  array = nullptr; // frees; the sanitizers would see a leak or a double free
}

TEST(ArrayMemory, IsFreedWhenAPassDoesNotNeedIt)
{
  ArrayMemory memory;
  memory.startPass();
  makeArray(memory, kTuples, 1.0); // goes at once
  EXPECT_GT(memory.idleBytes(), 0u);
  memory.startPass();
  EXPECT_GT(memory.idleBytes(), 0u) << "this pass may need it";
  memory.startPass();
  EXPECT_EQ(memory.idleBytes(), 0u);
}

TEST(ArrayMemory, LeavesSmallArraysToTheSystem)
{
  ArrayMemory memory;
  vtkNew<vtkFloatArray> small;
  memory.allocate(small, 10);
  EXPECT_EQ(small->GetNumberOfTuples(), 10);
  small->Initialize();
  EXPECT_EQ(memory.idleBytes(), 0u);
}

TEST(ArrayMemory, ArraysMayGoInAnyThread)
{
  ArrayMemory memory;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
  {
    threads.emplace_back(
      [&memory, t]
      {
        for (int i = 0; i < 200; ++i)
        {
          vtkSmartPointer<vtkDoubleArray> array = makeArray(memory, 5000 + 100 * t, t);
          EXPECT_TRUE(holds(array, t));
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  memory.startPass();
  memory.startPass();
  EXPECT_EQ(memory.idleBytes(), 0u);
}

} // namespace
