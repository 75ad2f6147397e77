#include <cstdio>
#include <cstdlib>

#include "losses/transport/sliced/directions.hpp"

// print-directions COUNT SEED: the lines that `sliced` projects on, one per row.
int main(int count, char** words) {
  if (count != 3) {
    std::fputs("usage: print-directions COUNT SEED\n", stderr);
    return 2;
  }
  for (const bowstring::Vector3& axis : bowstring::sliced::directions(std::atoi(words[1]), std::atol(words[2]))) {
    std::printf("%.17g %.17g %.17g\n", axis[0], axis[1], axis[2]);
  }
  return 0;
}
