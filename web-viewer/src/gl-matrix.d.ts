// Types of the modules of gl-matrix. They are imported one by one, because esbuild keeps all functions of the modules
// that gl-matrix itself exports as namespaces.
declare module "gl-matrix/esm/mat4.js" {
  import { mat4 } from "gl-matrix";
  export = mat4;
}
declare module "gl-matrix/esm/vec3.js" {
  import { vec3 } from "gl-matrix";
  export = vec3;
}
declare module "gl-matrix/esm/vec4.js" {
  import { vec4 } from "gl-matrix";
  export = vec4;
}
