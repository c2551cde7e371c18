#include "uplift/base/file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "uplift/base/error.h"

namespace uplift::file_test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test.
class FileTest : public testing::Test {
 protected:
  FileTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::temp_directory_path() / ("uplift-" + std::to_string(::getpid()) + "-" + info->name());
    fs::create_directories(folder);
  }
  ~FileTest() override { fs::remove_all(folder); }
  int count() const { return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator())); }
  std::string error_of_reading(const fs::path& path) const {
    try {
      read_file(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  fs::path folder;
};

TEST_F(FileTest, ReadsBackWhatWasWritten) {
  const std::string text("line\n\0binary\xff\r\n", 15);
  write_file_atomically(folder / "a.txt", text);
  EXPECT_EQ(read_file(folder / "a.txt"), text);
  write_file_atomically(folder / "a.txt", "");
  EXPECT_EQ(read_file(folder / "a.txt"), "");
  EXPECT_EQ(count(), 1);  // nothing is left beside it
}

TEST_F(FileTest, AReaderNeverSeesAPart) {
  const fs::path path = folder / "a b.txt";
  const std::string first(200000, 'a'), second(100000, 'b');
  write_file_atomically(path, first);
  std::thread writer([&] {
    for (int i = 0; i < 50; ++i) write_file_atomically(path, i % 2 ? first : second);
  });
  for (int i = 0; i < 50; ++i) {
    const std::string seen = read_file(path);
    EXPECT_TRUE(seen == first || seen == second);
  }
  writer.join();
}

TEST_F(FileTest, AFailedWriteKeepsTheOldFile) {
  EXPECT_THROW(write_file_atomically(folder / "none" / "a.txt", "x"), fs::filesystem_error);
  fs::create_directory(folder / "taken");
  EXPECT_THROW(write_file_atomically(folder / "taken", "x"), fs::filesystem_error);
  EXPECT_TRUE(fs::is_directory(folder / "taken"));
  EXPECT_EQ(count(), 1);
}

TEST_F(FileTest, RespectsTheUsersMask) {
  const mode_t old = ::umask(027);
  write_file_atomically(folder / "a.txt", "x");
  ::umask(old);
  EXPECT_EQ(fs::status(folder / "a.txt").permissions() & fs::perms::mask, static_cast<fs::perms>(0640));
}

TEST_F(FileTest, AMissingFileNamesTheNearest) {
  write_file_atomically(folder / "case.toml", "");
  fs::create_directory(folder / "cases");
  const std::string place = folder.string();
  EXPECT_EQ(error_of_reading(folder / "csae.toml"),
            place + "/csae.toml: expected a file, found no file of this name (did you mean \"" + place + "/case.toml\"?)");
  EXPECT_EQ(error_of_reading(folder / "other.txt"), place + "/other.txt: expected a file, found no file of this name");
  EXPECT_EQ(error_of_reading(folder / "none/a"), place + "/none/a: expected a file, found no folder \"" + place + "/none\"");
  EXPECT_EQ(error_of_reading(folder / "cases"), place + "/cases: expected a file, found a folder");
}

// Reading a socket, a pipe or a device might never end.
TEST_F(FileTest, WhatIsNoRegularFileIsAnError) {
  const fs::path path = folder / "a";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.string().size(), sizeof address.sun_path);
  path.string().copy(address.sun_path, sizeof address.sun_path - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(error_of_reading(path),
            path.string() + ": expected a regular file, found a pipe, a device or a socket (write its content to a file first)");
  ::close(socket);
}

// Source: FIPS 180-4 examples (NIST, "SHA256.pdf"), and the long messages of the same collection.
TEST(Sha256, FipsVectors) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu"),
            "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// Lengths around the borders of the padding. Source: Python's hashlib.
TEST(Sha256, LengthsAroundABlock) {
  EXPECT_EQ(sha256(std::string(55, 'a')), "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  EXPECT_EQ(sha256(std::string(56, 'a')), "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
  EXPECT_EQ(sha256(std::string(63, 'a')), "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34");
  EXPECT_EQ(sha256(std::string(64, 'a')), "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
  EXPECT_EQ(sha256(std::string(65, 'a')), "635361c48bb9eab14198e76ea8ab7f1a41685d6ad62aa9146d301d4f17eb0ae0");
  EXPECT_EQ(sha256(std::string(120, '\xff')), "9088fee917e5a748c2f0b4f5458c1cbdabbd696291c69be6e605bae0ef779e8f");
}

}  // namespace
}  // namespace uplift::file_test
