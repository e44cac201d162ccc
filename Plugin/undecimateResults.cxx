// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "undecimateResults.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkProcessModule.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"

#include <cstring>

namespace
{

bool isOurs(vtkSMProxy* proxy)
{
  const char* group = proxy->GetXMLGroup();
  const char* name = proxy->GetXMLName();
  return group && name && std::strcmp(group, "filters") == 0 &&
    (std::strcmp(name, "HashQueueDecimation") == 0 || std::strcmp(name, "TriQuadDecimation") == 0 ||
      std::strcmp(name, "Undecimation") == 0);
}

void onUpdated(vtkObject* caller, unsigned long, void*, void*)
{
  if (vtkSMProxy* proxy = vtkSMProxy::SafeDownCast(caller))
  {
    proxy->UpdatePropertyInformation();
  }
}

void onRegistered(vtkObject*, unsigned long, void* watcher, void* callData)
{
  const auto* info = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(callData);
  auto* command = static_cast<vtkCallbackCommand*>(watcher);
  // A proxy may be registered under several names.
  if (info && info->Type == vtkSMProxyManager::RegisteredProxyInformation::PROXY && info->Proxy &&
    isOurs(info->Proxy) && !info->Proxy->HasObserver(vtkCommand::UpdateDataEvent, command))
  {
    info->Proxy->AddObserver(vtkCommand::UpdateDataEvent, command);
  }
}

} // namespace

void undecimateWatchResults()
{
  switch (vtkProcessModule::GetProcessType())
  {
    case vtkProcessModule::PROCESS_CLIENT:
    case vtkProcessModule::PROCESS_BATCH:
      break;
    default:
      return;
  }
  // The commands are kept by the objects that they watch.
  vtkNew<vtkCallbackCommand> updated;
  updated->SetCallback(onUpdated);
  vtkNew<vtkCallbackCommand> registered;
  registered->SetCallback(onRegistered);
  updated->Register(nullptr);
  registered->SetClientData(updated);
  registered->SetClientDataDeleteCallback(
    [](void* command) { static_cast<vtkCallbackCommand*>(command)->UnRegister(nullptr); });
  vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, registered);
}
