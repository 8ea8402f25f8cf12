// Did the driver end loops? llvmpipe (Mesa 22.3) ends all loops of an invocation, and of the seven that run with it, after 65535
// iterations in all and says nothing. From then on every loop is left after its first iteration: so is this one.
uniform int three;  // 3, where no compiler can see it

bool loops_cut() {
  int count = 0;
  for (int i = 0; i < three; ++i) ++count;
  return count < three;
}
