#include "cad_import/src/kernel_session.h"

#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <algorithm>

namespace catoptra::cad_import {
namespace {

std::mutex& kernel_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

void MessageCollector::send(const TCollection_AsciiString& text, const Message_Gravity gravity) const {
  if (gravity < Message_Alarm || messages_.size() >= kMaxMessages) return;
  std::string line(text.ToCString(), std::size_t(text.Length()));
  std::ranges::replace(line, '\n', ' ');
  if (!line.empty() && std::ranges::find(messages_, line) == messages_.end())
    messages_.push_back(std::move(line));
}

KernelSession::KernelSession() : lock_(kernel_mutex()), collector_(new MessageCollector) {
  const Handle(Message_Messenger)& messenger = Message::DefaultMessenger();
  printers_ = messenger->Printers();
  messenger->ChangePrinters().Clear();
  messenger->AddPrinter(collector_);
  STEPControl_Controller::Init();  // both register the settings they use
  IGESControl_Controller::Init();
  set("xstep.cascade.unit", "MM");
  set("read.stepcaf.subshapes.name", "0");  // names are taken from the entities, see read_step.cpp
  set("write.step.unit", "MM");
}

KernelSession::~KernelSession() {
  for (auto it = settings_.rbegin(); it != settings_.rend(); ++it)
    Interface_Static::SetCVal(it->first.c_str(), it->second.c_str());
  Message::DefaultMessenger()->ChangePrinters() = printers_;
}

void KernelSession::set(const char* name, const char* value) {
  if (!Interface_Static::IsPresent(name)) return;
  settings_.emplace_back(name, Interface_Static::CVal(name));
  Interface_Static::SetCVal(name, value);
}

}  // namespace catoptra::cad_import
