#include "app/src/file_hash.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>

#include "cad_import/error.h"

namespace catoptra::app {
namespace {

/// A running SHA-256.
class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    check(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(std::string_view bytes) {
    check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  [[nodiscard]] std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> value{};
    unsigned size = 0;
    check(EVP_DigestFinal_ex(context_.get(), value.data(), &size) == 1);
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
      text += kDigits[value[i] >> 4];
      text += kDigits[value[i] & 15];
    }
    return text;
  }

 private:
  static void check(bool done) {
    if (!done) throw Error("", "SHA-256", "the library OpenSSL cannot calculate it");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.hexadecimal();
}

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Digest digest;
  std::array<char, 65536> block{};
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0)
    digest.add({block.data(), static_cast<std::size_t>(stream.gcount())});
  if (!stream.eof()) throw Error(file.string(), "", "cannot be read", "does it exist and may you read it?");
  return digest.hexadecimal();
}

std::vector<InputFile> input_files(std::span<const std::filesystem::path> files) {
  std::vector<InputFile> inputs;
  for (const std::filesystem::path& file : files) {
    const auto same = [&](const InputFile& input) { return input.file == file.string(); };
    if (!file.empty() && std::none_of(inputs.begin(), inputs.end(), same))
      inputs.push_back({file.string(), sha256_of_file(file)});
  }
  return inputs;
}

}  // namespace catoptra::app
