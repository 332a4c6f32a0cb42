import { effect } from "@preact/signals-core";
import type { Commands, Drop } from "../connection/commands";
import type { Outcome } from "../connection/link";
import type { ViewRequest } from "../connection/messages";
import type { DialPosition } from "../gen/spherule/v1/diagnostics_pb";
import type { Choices, RotationChoice, ToolName } from "./choices";
import type { Facts, Vec3 } from "../model/facts";
import { defaultMode, modes, quantityOf } from "../model/quantities";
import type { Mode } from "../model/quantities";
import type { Session } from "../model/session";
import { largestSide } from "../renderer/picture";
import type { RenderQualityChoice } from "../renderer/render_quality";
import type { ThemeName } from "../renderer/theme";
import { fromAuto, goalNames, goals, toAuto } from "./auto_goal";
import type { GoalName } from "./auto_goal";
import { ChartFolder } from "./chart_folder";
import { Controls } from "./controls";
import { CutFolder } from "./cut_folder";
import { Dial } from "./dial";
import { h } from "./dom";
import type { EntryRule } from "./entry";
import { Folder, rememberFolders } from "./folder";
import type { NumberField } from "./number_field";
import type { LoadPart } from "./parts";
import {
  customGravity,
  dropCountFor,
  dropFor,
  dropRadiusFor,
  dropRadiusRule,
  gravityPresetOf,
  gravityPresets,
  impulseFor,
  impulseNote,
  impulseRule,
} from "./presets";
import { refusalText } from "./refusals";
import { sceneFolder } from "./scene_folder";
import { fillStatistics } from "./statistics_folders";
import type { Steering } from "./steering";
import { StreamFolder } from "./stream_folder";

export interface PanelActions {
  viewRequested(view: ViewRequest): void;
  forgetToken(): void;
  showScenes(): void;
  copyLink(): void;
  openFile(): void;
  savePicture(width: number, height: number): void; // px
  saveScene(): void;
  editScene(): void;
  loadPart: LoadPart;
}

const tools: Record<string, ToolName> = { Select: "select", Push: "push", Pull: "pull", Drop: "drop" };
const rotations: Record<string, RotationChoice> = { Automatic: "auto", Shown: "shown", Hidden: "hidden" };
const qualities: Record<string, RenderQualityChoice> = { Automatic: "auto", Full: "full", Light: "light" };
const themes: Record<string, ThemeName> = { Light: "light", Dark: "dark" };
const paths = { Shown: true, Hidden: false };
const colours: Record<string, Mode> = Object.fromEntries(modes.map((mode) => [quantityOf(mode).label, mode]));
const gravityRule: EntryRule = { unit: "m/s²", least: -1e6, most: 1e6 };
const countRule: EntryRule = { unit: "", whole: true, least: 1, most: 16_000_000 };
const sizeRule: EntryRule = { unit: "px", whole: true, least: 16, most: largestSide };
const axes = ["x", "y", "z"] as const;

/** The control panel. Its controls follow the session and the choices of the user. */
export class Panel {
  readonly element: HTMLElement;
  readonly stream: StreamFolder;
  readonly charts: ChartFolder;
  /** Room for the arrow of gravity, which is loaded later. */
  readonly arrowRoom = h("div", { class: "arrow-room" });
  private readonly fields: NumberField[] = [];
  private dropCount!: NumberField;
  private dropRadius!: NumberField;
  private impulse!: NumberField;

  constructor(
    private readonly session: Session,
    private readonly commands: Commands,
    private readonly steering: Steering,
    private readonly choices: Choices,
    private readonly actions: PanelActions,
  ) {
    const cut = new CutFolder(session, choices.cut);
    this.stream = new StreamFolder(choices, (view) => actions.viewRequested(view));
    const hidden = (): boolean => session.playing;
    const now = new Folder("Now", { hidden, folded: true });
    const rest = new Folder("Statistics", { hidden, folded: true });
    fillStatistics(now, rest, session, actions.loadPart);
    this.charts = new ChartFolder(actions.loadPart);
    const folders = [
      this.dropFolder(),
      this.toolFolder(),
      this.gravityFolder(),
      this.qualityFolder(),
      this.worldFolder(),
      sceneFolder(session, commands, () => steering.blockedReason, actions.loadPart),
      this.lookFolder(),
      ...[cut.folder, this.stream.folder, now, rest, this.charts.folder],
      this.accessFolder(),
    ];
    rememberFolders(folders, () => localStorage);
    const elements = [this.files(), ...folders.map(({ element }) => element)];
    const attributes = { class: "panel", "data-testid": "panel", role: "region", "aria-label": "Controls" };
    this.element = h("div", attributes, h("div", { class: "folders" }, ...elements));
    effect(() => {
      if (steering.blockedReason || session.playing) choices.tool = "select";
    });
    effect(() => {
      const { most = Infinity } = impulseRule(session.settings);
      choices.impulse = Math.min(choices.impulse, most);
    });
  }

  /** Call when another scene is shown. Sets all values that depend on the scene. */
  sceneChanged(facts: Facts): void {
    const { choices } = this;
    choices.cut.reset();
    choices.dropRadius = dropRadiusFor(facts);
    choices.dropCount = dropCountFor(facts, choices.dropRadius);
    choices.impulse = impulseFor(choices.dropRadius);
    if (!choices.modeChosen) choices.mode = defaultMode(facts.population.groups);
    for (const field of this.fields) field.restore();
  }

  dropNow(): void {
    void this.dropSpheres();
  }

  /** Whether the impulse can be sent. If not, its field says why. */
  checkImpulse(): boolean {
    return this.impulse.check();
  }

  /** Shows at the field of the impulse why the server refused a push. */
  pushed(outcome: Outcome): void {
    if (outcome.case !== "refused" || outcome.value.field !== "push.impulse") return;
    this.impulse.refuse(refusalText(outcome.value));
  }

  /** Drops spheres in the region that `place` returns for their number and radius. */
  async dropSpheres(place: (facts: Facts, count: number, radius: number) => Drop = dropFor): Promise<void> {
    const { dropCount, dropRadius, choices } = this;
    const { facts } = this.session;
    if (!facts || !dropCount.check() || !dropRadius.check()) return;
    const outcome = await this.commands.drop(place(facts, choices.dropCount, choices.dropRadius));
    if (outcome.case === "applied") dropCount.restore();
    if (outcome.case !== "refused" || !outcome.value.field) return;
    const ofCount = outcome.value.field.endsWith(".count");
    (ofCount ? dropCount : dropRadius).refuse(refusalText(outcome.value));
  }

  /** A folder whose controls send commands. It is hidden for a recording, which has no such settings. */
  private simulated(name: string): Folder {
    return new Folder(name, {
      hidden: () => this.session.playing,
      blocked: () => this.steering.blockedReason,
    });
  }

  private number(folder: Folder, ...rest: Parameters<Folder["number"]>): NumberField {
    const field = folder.number(...rest);
    this.fields.push(field);
    return field;
  }

  /** The buttons at the top: scenes, files and links. */
  private files(): HTMLElement {
    const { actions, steering, session } = this;
    const hidden = (): boolean => session.playing;
    const controls = new Controls(() => steering.blockedReason);
    const blocked = (): string => ""; // the page itself acts
    controls.action("scenes", "Scenes…", () => actions.showScenes(), { hidden, blocked });
    const open = "Plays a recording (.sph) or loads a scene (.json). Both can also be dropped on the page";
    controls.action("open-file", "Open…", () => actions.openFile(), { title: open, blocked });
    const link = "Copies an address that opens this view";
    controls.action("copy-link", "Copy link", () => actions.copyLink(), { title: link, blocked });
    controls.action("save-scene", "Save scene", () => actions.saveScene(), {
      title: "Saves the spheres as they are now, as a scene file (.json)",
      hidden,
      blocked: () => steering.awayReason,
    });
    controls.action("edit-scene", "Write a scene…", () => actions.editScene(), { hidden });
    return controls.body;
  }

  private dropFolder(): Folder {
    const { choices, session } = this;
    const folder = this.simulated("Drop spheres");
    this.dropCount = this.number(folder, "drop-count", "Count", {
      get: () => choices.dropCount,
      set: (count) => (choices.dropCount = count),
      rule: () => countRule,
    });
    this.dropRadius = this.number(folder, "drop-radius", "Radius, m", {
      get: () => choices.dropRadius,
      set: (radius) => (choices.dropRadius = radius),
      rule: () => dropRadiusRule(session.facts),
    });
    folder.action("drop", "Drop", () => this.dropNow());
    return folder;
  }

  private toolFolder(): Folder {
    const { choices, session } = this;
    const folder = this.simulated("Click and drag");
    folder.choice("tool", "Tool", {
      title: "Select a sphere, push it, drag it by a spring, or drop spheres at the place of a click",
      options: tools,
      get: () => choices.tool,
      set: (tool) => (choices.tool = tool),
    });
    this.impulse = this.number(folder, "impulse", "Push, N s", {
      title: impulseNote,
      get: () => choices.impulse,
      set: (impulse) => (choices.impulse = impulse),
      rule: () => impulseRule(session.settings),
    });
    return folder;
  }

  private gravityFolder(): Folder {
    const { session, commands } = this;
    const folder = this.simulated("Gravity");
    const gravity = (): Vec3 => (session.settings?.gravity ?? [0, 0, 0]) as Vec3;
    const set = (value: Vec3): Promise<Outcome> => commands.set("Gravity", { gravity: value });
    const preset = folder.choice("gravity-preset", "Preset, m/s²", {
      options: gravityPresets,
      other: customGravity,
      get: () => gravityPresets[gravityPresetOf(gravity())],
      send: set,
    });
    const fields = axes.map((axis, k) => {
      const field = this.number(folder, `gravity-${axis}`, axis, {
        get: () => gravity()[k] as number,
        send: () => set(fields.map(({ value }) => value) as Vec3),
        rule: () => gravityRule,
      });
      field.input.setAttribute("aria-label", `Gravity, ${axis}, m/s²`);
      return field;
    });
    preset.setAttribute("aria-label", "Preset of gravity, m/s²");
    folder.body.append(this.arrowRoom);
    return folder;
  }

  private qualityFolder(): Folder {
    const { session, commands, steering } = this;
    const folder = this.simulated("Quality");
    const turned = ({ model, substeps, own }: DialPosition): Promise<Outcome> =>
      commands.set("Quality", own ? { model } : { model, substeps });
    const dial = new Dial(session, () => steering.blockedReason, turned);
    folder.body.append(dial.element);
    const goal = (): GoalName => fromAuto(session.settings?.auto).auto;
    folder.choice("auto", "Automatic", {
      title: "Adjusts the substeps to hold a step time or a mean overlap",
      options: goalNames,
      get: goal,
      send: (name) => commands.set("Automatic", { auto: toAuto(name, goals[name].first) }),
    });
    this.number(folder, "goal", () => goals[goal()].label, {
      get: () => fromAuto(session.settings?.auto).goal,
      send: (value) => commands.set("Automatic", { auto: toAuto(goal(), value) }),
      rule: () => goals[goal()].rule,
      hidden: () => goal() === "off",
    });
    return folder;
  }

  /** The settings of the simulation; of a recording, the speed. */
  private worldFolder(): Folder {
    const { session, commands, steering } = this;
    const title = (): string => (session.playing ? "Recording" : "World");
    const folder = new Folder("World", { title, blocked: () => steering.blockedReason });
    const hidden = (): boolean => session.playing;
    this.number(folder, "restitution", "Restitution", {
      get: () => session.settings?.restitution ?? 0,
      send: (restitution) => commands.set("Restitution", { restitution }),
      rule: () => ({ unit: "", least: 0, most: 1 }),
      slider: [0, 1, 0.01],
      hidden,
    });
    this.number(folder, "friction", "Friction", {
      get: () => session.settings?.friction ?? 0,
      send: (friction) => commands.set("Friction", { friction }),
      rule: () => ({ unit: "", least: 0, most: 100 }),
      slider: [0, 1, 0.01],
      hidden,
    });
    this.number(folder, "speed", "Speed, ×", {
      get: () => session.settings?.speed ?? 1,
      send: (speed) => commands.set("Speed", { speed }),
      rule: () => ({ unit: "×", least: 0.001, most: 1000 }),
      slider: [0.05, 4, 0.05],
    });
    return folder;
  }

  private lookFolder(): Folder {
    const { actions, choices, session } = this;
    const folder = new Folder("Look");
    folder.choice("colour", "Colour by", {
      options: colours,
      get: () => choices.mode,
      set: (mode) => choices.colourBy(mode),
    });
    folder.choice("trace", "Path", {
      title: "Shows the path of the selected sphere",
      options: paths,
      get: () => choices.trace,
      set: (shown) => (choices.trace = shown),
    });
    folder.choice("rotation", "Rotation", {
      title: "Shows how spheres turn. Automatic: in full quality, up to 10,000 spheres",
      options: rotations,
      get: () => choices.rotation,
      set: (rotation) => (choices.rotation = rotation),
      hidden: () => !session.settings?.rotates,
    });
    folder.choice("quality", "Image quality", {
      options: qualities,
      get: () => choices.quality,
      set: (quality) => (choices.quality = quality),
    });
    const width = this.number(folder, "picture-width", "Picture width, px", {
      get: () => choices.pictureWidth,
      set: (size) => (choices.pictureWidth = size),
      rule: () => sizeRule,
    });
    const height = this.number(folder, "picture-height", "Picture height, px", {
      get: () => choices.pictureHeight,
      set: (size) => (choices.pictureHeight = size),
      rule: () => sizeRule,
    });
    const save = (): void => {
      if (width.check() && height.check()) actions.savePicture(choices.pictureWidth, choices.pictureHeight);
    };
    const title = "Saves what the page shows, without its controls, as a PNG file";
    folder.action("save-picture", "Save picture", save, { title });
    folder.choice("theme", "Theme", {
      options: themes,
      get: () => choices.theme,
      set: (theme) => choices.chooseTheme(theme),
    });
    return folder;
  }

  /** Hidden while there is no token. */
  private accessFolder(): Folder {
    const { actions, session } = this;
    const folder = new Folder("Access", { hidden: () => !session.tokenHeld });
    const title = "This tab remembers the token until it is closed";
    folder.action("forget-token", "Forget token", () => actions.forgetToken(), { title });
    return folder;
  }
}
