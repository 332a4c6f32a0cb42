flat in uint v_code;
layout(location = 1) out uint o_code;

void main() { o_code = v_code; }
