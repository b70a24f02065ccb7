#include <cstdio>

#include "app/version.h"

int main() {
  std::printf("catoptra %s\n", catoptra::app::version().data());
  return 0;
}
