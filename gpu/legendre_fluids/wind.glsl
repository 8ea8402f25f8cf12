// Air that blows through the box, linear in space [half sizes per second]: in the middle, and its slopes by column.
uniform vec3 wind;
uniform mat3 wind_slopes;
float node(int i) { return number(TABLE_NODES, i); }
