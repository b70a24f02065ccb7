// Fence around the CAD kernel's process-wide state: one session at a time, its settings and message printers
// put back.
#pragma once

#include <Message_Printer.hxx>
#include <Message_SequenceOfPrinters.hxx>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace catoptra::cad_import {

/// Collects the kernel's messages instead of letting them reach standard output.
class MessageCollector : public Message_Printer {
  DEFINE_STANDARD_RTTI_INLINE(MessageCollector, Message_Printer)
 public:
  /// Failures and alarms, in order, each once, at most kMaxMessages.
  [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }
  static constexpr std::size_t kMaxMessages = 20;

 protected:
  void send(const TCollection_AsciiString& text, const Message_Gravity gravity) const override;

 private:
  mutable std::vector<std::string> messages_;
};

/// While it lives, this thread alone reads, writes or meshes with the kernel; lengths come out in mm,
/// messages are collected. Its end restores the settings and printers it found. Not for evaluation: that
/// needs no kernel state.
class KernelSession {
 public:
  KernelSession();
  ~KernelSession();
  KernelSession(const KernelSession&) = delete;
  KernelSession& operator=(const KernelSession&) = delete;

  [[nodiscard]] const std::vector<std::string>& messages() const { return collector_->messages(); }

  /// Sets one of the translators' static parameters until the session ends; unknown names are passed over.
  void set(const char* name, const char* value);

 private:
  std::unique_lock<std::mutex> lock_;
  Handle(MessageCollector) collector_;
  Message_SequenceOfPrinters printers_;
  std::vector<std::pair<std::string, std::string>> settings_;
};

}  // namespace catoptra::cad_import
