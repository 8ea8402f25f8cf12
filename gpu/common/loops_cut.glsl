// Did the driver end loops? llvmpipe (Mesa 22.3) ends all loops of an invocation, and of the seven that run with it, after 65535
// iterations in all and says nothing. From then on every loop is left after its first iteration: so is this one.
uniform int loop_count;  // 3, from where no compiler can see it

bool loops_cut() {
  int count = 0;
  for (int i = 0; i < loop_count; ++i) ++count;
  return count < loop_count;
}
