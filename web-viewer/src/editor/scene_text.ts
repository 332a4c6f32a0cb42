import { jsonLanguage } from "@codemirror/lang-json";
import { fromJson, toBinary } from "@bufbuild/protobuf";
import type { DescMessage, JsonValue } from "@bufbuild/protobuf";
import { SceneSchema } from "../gen/spherule/v1/scene_pb";
import type { Scene } from "../gen/spherule/v1/scene_pb";

/** A fault of a scene file, with its place in the text. */
export interface Fault {
  from: number;
  to: number;
  message: string;
}

type Node = ReturnType<typeof jsonLanguage.parser.parse>["topNode"];

const mostBytes = 1_000_000; // of a scene in a message to the server, which takes 1 MiB
const mostFaults = 20;
const serveIt = "start the server with this file: spherule serve FILE";

/** The text of a scene file as a message, or its faults. */
export function readScene(text: string): { scene?: Scene; faults: Fault[] } {
  const top = jsonLanguage.parser.parse(text).topNode;
  let json: JsonValue;
  try {
    json = JSON.parse(text) as JsonValue;
  } catch (error) {
    return { faults: [{ ...placeOfError(top, text), message: syntaxText(error) }] };
  }
  const root = top.firstChild ?? top;
  const faults: Fault[] = [];
  check(SceneSchema, root, text, faults);
  if (faults.length > 0) return { faults };
  try {
    const scene = fromJson(SceneSchema, json);
    const { length } = toBinary(SceneSchema, scene);
    if (length <= mostBytes) return { scene, faults };
    const size = `${(length / 1e6).toFixed(1)} MB are too many for a page, which can load 1 MB`;
    return { faults: [{ from: root.from, to: root.from + 1, message: `${size}: ${serveIt}` }] };
  } catch (error) {
    return { faults: [{ from: root.from, to: root.from + 1, message: wrongText(error) }] };
  }
}

/** The place of a field in the text: of the part of the path that the text has. `field`: as in Refused.field. */
export function placeOf(text: string, field: string): { from: number; to: number } {
  const top = jsonLanguage.parser.parse(text).topNode;
  let node = top.firstChild ?? top;
  let place = { from: node.from, to: Math.min(node.to, node.from + 1) };
  for (const part of field.replace(/^load\.(scene\.?)?/, "").match(/[^.[\]]+/g) ?? []) {
    const next = node.name === "Array" ? valuesOf(node)[Number(part)] : propertyOf(node, text, part)?.lastChild;
    if (!next) break;
    node = next;
    place = { from: node.from, to: node.to };
  }
  return place;
}

function check(message: DescMessage, node: Node, text: string, faults: Fault[]): void {
  const add = ({ from, to }: Node, reason: string): void => {
    if (faults.length < mostFaults) faults.push({ from, to, message: reason });
  };
  if (node.name !== "Object") return add(node, "must be an object, such as { … }");
  for (const property of node.getChildren("Property")) {
    const [name, value] = [property.firstChild, property.lastChild];
    if (!name || !value) continue;
    const key = JSON.parse(text.slice(name.from, name.to)) as string;
    const field = message.fields.find((one) => one.jsonName === key || one.name === key);
    if (!field) {
      add(name, `"${key}" is not known here. Known are ${message.fields.map((one) => one.jsonName).join(", ")}`);
    } else if (field.message && field.fieldKind === "list" && value.name === "Array") {
      for (const one of valuesOf(value)) check(field.message, one, text, faults);
    } else if (field.message && field.fieldKind !== "list") {
      check(field.message, value, text, faults);
    } else {
      try {
        fromJson(message, { [key]: JSON.parse(text.slice(value.from, value.to)) as JsonValue });
      } catch (error) {
        add(value, `${key}: ${wrongText(error)}`);
      }
    }
    if (["Csv", "Xyz", "Lammps"].includes(field?.message?.name ?? "")) {
      add(value, `A page cannot send files: give the spheres as a list, or ${serveIt}`);
    }
  }
}

function valuesOf(array: Node): Node[] {
  const values: Node[] = [];
  for (let node = array.firstChild; node; node = node.nextSibling) if (/^[A-Z]/.test(node.name)) values.push(node);
  return values;
}

function propertyOf(object: Node, text: string, name: string): Node | undefined {
  const camel = name.replace(/_(\w)/g, (_, letter: string) => letter.toUpperCase());
  return object.getChildren("Property").find(({ firstChild: key }) => {
    const given = key && (JSON.parse(text.slice(key.from, key.to)) as string);
    return given === name || given === camel;
  });
}

/** The first place at which the text is no JSON. */
function placeOfError(top: Node, text: string): { from: number; to: number } {
  const cursor = top.cursor();
  do {
    if (cursor.type.isError) return { from: Math.min(cursor.from, text.length), to: Math.max(cursor.to, cursor.from) };
  } while (cursor.next());
  return { from: 0, to: 0 };
}

function syntaxText(error: unknown): string {
  const text = error instanceof Error ? error.message : String(error);
  return `This is not JSON: ${text.replace(/ in JSON at position.*| \(line .*/s, "")}`;
}

function wrongText(error: unknown): string {
  const text = error instanceof Error ? error.message : String(error);
  return text.replace(/^.* from JSON: /, "");
}
