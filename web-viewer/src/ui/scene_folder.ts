import { effect, signal } from "@preact/signals-core";
import type { Commands } from "../connection/commands";
import type { Session } from "../model/session";
import type { PartLists } from "../scene_parts/scene_parts";
import { Folder } from "./folder";
import type { LoadPart } from "./parts";

/**
 * Returns the folder of the panel with the fields, emitters, materials and groups of the scene. Its lists are loaded
 * when it is first open. `blockedReason`: why the user may not change them; empty if they may.
 */
export function sceneFolder(session: Session, commands: Commands, blockedReason: () => string, load: LoadPart): Folder {
  const folder = new Folder("Scene", { hidden: () => session.playing, folded: true });
  const lists = signal<PartLists | undefined>(undefined);
  let loading = false;
  const begin = async (): Promise<void> => {
    loading = true;
    const part = await load<{ PartLists: new (commands: Commands) => PartLists }>("scene_parts");
    loading = false;
    if (!part) return;
    const made = new part.PartLists(commands);
    folder.body.append(made.element);
    lists.value = made;
  };
  effect(() => {
    const { parts, facts } = session;
    const reason = blockedReason();
    if (!folder.open || session.spheres === undefined || !facts || !parts) return; // `spheres`: follows the groups
    if (lists.value) lists.value.show(parts, facts, reason);
    else if (!loading) void begin();
  });
  return folder;
}
