// The numbers of the rule or of the polynomial, whichever is compiled.
layout(std140, binding = AT_EVALUATOR) uniform Evaluator { vec4 evaluator[MOST_NODES]; };
