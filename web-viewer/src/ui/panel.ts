import GUI from "lil-gui";
import type { Controller, NumberController } from "lil-gui";
import type { Commands, Drop } from "../connection/commands";
import type { Outcome } from "../connection/link";
import type { ViewRequest } from "../connection/messages";
import type { Settings } from "../gen/spherule/v1/control_pb";
import type { Diagnostics, Dial as DialMessage } from "../gen/spherule/v1/diagnostics_pb";
import type { Cut } from "../model/cut";
import type { Facts } from "../model/facts";
import { defaultMode, modes, quantityOf } from "../model/quantities";
import type { Mode } from "../model/quantities";
import { largestSide } from "../renderer/picture";
import type { RenderQualityChoice } from "../renderer/render_quality";
import type { ThemeName } from "../renderer/theme";
import { fromAuto, goalNames, goals, toAuto } from "./auto_goal";
import type { GoalName } from "./auto_goal";
import { ChartFolder } from "./chart_folder";
import { nameFolders, Restriction, tag } from "./controllers";
import { CutFolder } from "./cut_folder";
import { Dial } from "./dial";
import { h } from "./dom";
import { Entry } from "./entry";
import type { EntryRule } from "./entry";
import { rememberFolders } from "./folders";
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
import { StatisticsFolders } from "./statistics_folders";
import { StreamFolder } from "./stream_folder";

/** Choices of the user that concern only this page. */
export interface Choices {
  mode: Mode;
  modeChosen: boolean; // false: the scene determines the mode
  rotation: "auto" | "shown" | "hidden"; // the pattern that turns with the spheres
  quality: RenderQualityChoice;
  theme: ThemeName;
  themeChosen: boolean; // false: the system determines the theme
  tool: "select" | "push" | "pull" | "drop"; // the effect of a click or a drag on the picture
  impulse: number; // N s
  view: ViewRequest;
  cut: Cut;
  trace: boolean; // the path of the selected sphere is shown
}

export interface PanelActions {
  themeChanged(theme: ThemeName): void;
  qualityChanged(quality: RenderQualityChoice): void;
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

const rotationNames = { Automatic: "auto", Shown: "shown", Hidden: "hidden" };
const qualityNames = { Automatic: "auto", Full: "full", Light: "light" };
const gravityRule: EntryRule = { unit: "m/s²", least: -1e6, most: 1e6 };
const capital = (word: string): string => word.charAt(0).toUpperCase() + word.slice(1);
const toolNames = { Select: "select", Push: "push", Pull: "pull", Drop: "drop" };
const themeNames = { Light: "light", Dark: "dark" };

/**
 * The panel at the side. It sends a command when a control is released, and shows the settings that the server reports.
 */
export class Panel {
  readonly element: HTMLElement;
  readonly stream: StreamFolder;
  readonly cut: CutFolder;
  readonly charts: ChartFolder;
  private readonly gui: GUI;
  private readonly statistics: StatisticsFolders;
  private readonly world = {
    gravity: "Earth",
    x: 0,
    y: 0,
    z: 0,
    restitution: 0.5,
    friction: 0,
    speed: 1,
    auto: "off" as GoalName,
    goal: 0, // in the unit shown
  };
  private readonly picture = { width: 3840, height: 2160 }; // px
  private readonly drop = { count: 200, radius: 0.05 };
  private readonly steering: GUI[] = []; // folders whose controls send commands
  private readonly simulated: GUI[] = []; // folders that are hidden for a recording
  private playback!: GUI; // the folder of which a recording uses the speed
  private readonly access: GUI; // hidden while there is no token
  private readonly restriction: Restriction;
  private readonly saving: Restriction; // viewers may save, too
  private readonly scenes: Controller;
  private readonly save: Controller;
  private readonly edit: Controller;
  /** Room for the arrow of gravity, which is loaded later. */
  readonly arrowRoom = h("div", { class: "arrow-room" });
  private readonly dial = new Dial(
    ({ model, substeps, own }) => void this.change("Quality", own ? { model } : { model, substeps }),
  );
  private goal!: NumberController;
  private rotation!: Controller; // hidden while no sphere rotates
  private readonly entries = new Map<string, Entry>(); // by the name of the control
  private facts: Facts | undefined;
  private settings: Settings | undefined;

  constructor(
    private readonly commands: Commands,
    readonly choices: Choices,
    private readonly actions: PanelActions,
  ) {
    this.gui = new GUI({ autoPlace: false, injectStyles: false, touchStyles: 0, title: "Controls", width: 288 });
    this.element = this.gui.domElement;
    this.element.dataset.testid = "panel";
    this.scenes = tag("scenes", this.gui.add({ act: () => actions.showScenes() }, "act").name("Scenes…"));
    const open = tag("open-file", this.gui.add({ act: () => actions.openFile() }, "act").name("Open…"));
    open.domElement.title = "Plays a recording (.sph) or loads a scene (.json). Both can also be dropped on the page";
    const copy = tag("copy-link", this.gui.add({ act: () => actions.copyLink() }, "act").name("Copy link"));
    copy.domElement.title = "Copies an address that opens this view";
    this.save = tag("save-scene", this.gui.add({ act: () => actions.saveScene() }, "act").name("Save scene"));
    this.save.domElement.title = "Saves the spheres as they are now, as a scene file (.json)";
    this.edit = tag("edit-scene", this.gui.add({ act: () => actions.editScene() }, "act").name("Write a scene…"));
    this.addDrop();
    this.addPush();
    this.addGravity();
    this.addQuality();
    this.addWorld();
    this.addLook();
    const cut = this.gui.addFolder("Show");
    this.cut = new CutFolder(cut, choices.cut);
    const requested = (view: ViewRequest): void => actions.viewRequested(view);
    const stream = this.gui.addFolder("Stream");
    this.stream = new StreamFolder(stream, choices.view, requested);
    const now = this.addSimulated("Now");
    const statistics = this.addSimulated("Statistics");
    this.statistics = new StatisticsFolders(now, statistics, actions.loadPart);
    const charts = this.gui.addFolder("Charts");
    this.charts = new ChartFolder(charts, actions.loadPart);
    this.access = this.gui.addFolder("Access").hide();
    const forget = this.access.add({ act: () => actions.forgetToken() }, "act").name("Forget token");
    tag("forget-token", forget).domElement.title = "This tab remembers the token until it is closed";
    nameFolders(this.gui);
    rememberFolders(this.gui, [cut, stream, now, statistics, charts], () => localStorage);
    this.restriction = new Restriction([this.edit, ...this.steering.flatMap((folder) => folder.controllers)]);
    this.saving = new Restriction([this.save]);
  }

  /** Disables all controls that send commands; an empty reason enables them. */
  restrict(blockedReason: string, awayReason: string): void {
    if (blockedReason) this.choices.tool = "select";
    this.restriction.set(blockedReason);
    this.saving.set(awayReason);
    this.dial.restrict(blockedReason);
    this.refresh();
  }

  setTokenHeld(held: boolean): void {
    this.access.show(held);
  }

  /** `playing`: the server plays a recording. Hides the controls that then have no effect. */
  setPlaying(playing: boolean): void {
    if (playing) this.choices.tool = "select";
    for (const scene of [this.scenes, this.save, this.edit]) scene.show(!playing);
    for (const folder of this.simulated) folder.show(!playing);
    for (const controller of this.playback.controllers) controller.show(!playing || controller.property === "speed");
    this.playback.title(playing ? "Recording" : "World");
    this.refresh();
  }

  /** `another`: it is another scene than before. */
  setFacts(facts: Facts, another: boolean): void {
    this.facts = facts;
    if (another) {
      this.cut.reset();
      for (const entry of this.entries.values()) entry.restore();
      this.drop.radius = dropRadiusFor(facts);
      this.drop.count = dropCountFor(facts, this.drop.radius);
      this.choices.impulse = impulseFor(this.drop.radius);
      if (!this.choices.modeChosen) this.choices.mode = defaultMode(facts.population.groups);
    }
    this.refresh();
  }

  setSettings(settings: Settings): void {
    this.settings = settings;
    const [x = 0, y = 0, z = 0] = settings.gravity;
    const { restitution, friction, speed } = settings;
    const gravity = gravityPresetOf([x, y, z]);
    const values = { x, y, z, gravity, restitution, friction, speed, ...fromAuto(settings.auto) };
    const edited = this.edited();
    if (edited) delete (values as Partial<typeof values>)[edited as keyof typeof values];
    Object.assign(this.world, values);
    this.choices.impulse = Math.min(this.choices.impulse, impulseRule(settings).most ?? Infinity);
    this.dial.setSettings(settings);
    this.rotation.show(settings.rotates);
    this.goal.show(this.world.auto !== "off").name(goals[this.world.auto].label);
    this.refresh();
  }

  setDial(dial: DialMessage): void {
    this.dial.setDial(dial);
  }

  setDiagnostics(diagnostics: Diagnostics): void {
    this.statistics.show(diagnostics, this.settings);
  }

  /** Shows values that have been changed outside of the panel. */
  refresh(): void {
    for (const controller of this.gui.controllersRecursive()) controller.updateDisplay();
  }

  colourBy(mode: Mode): void {
    this.choices.mode = mode;
    this.choices.modeChosen = true;
    this.refresh();
  }

  dropNow(): void {
    void this.dropSpheres();
  }

  /** Whether the impulse can be sent. If not, its field says why. */
  checkImpulse(): boolean {
    return this.entries.get("impulse")?.check() ?? true;
  }

  /** Shows at the field of the impulse why the server refused a push. */
  pushed(outcome: Outcome): void {
    if (outcome.case !== "refused" || outcome.value.field !== "push.impulse") return;
    this.entries.get("impulse")?.refuse(refusalText(outcome.value));
  }

  /** Drops spheres in the region that `place` returns for their number and radius. */
  async dropSpheres(place: (facts: Facts, count: number, radius: number) => Drop = dropFor): Promise<void> {
    const [count, radius] = [this.entries.get("drop-count"), this.entries.get("drop-radius")];
    if (!this.facts || !count?.check() || !radius?.check()) return;
    const outcome = await this.commands.drop(place(this.facts, this.drop.count, this.drop.radius));
    if (outcome.case === "applied") count.restore();
    if (outcome.case !== "refused" || !outcome.value.field) return;
    const ofCount = outcome.value.field.endsWith(".count");
    (ofCount ? count : radius).refuse(refusalText(outcome.value));
  }

  /** Sends a change of settings. If the server refuses it, the setting stays, and the field at `entry` says why. */
  private async change(name: string, settings: Parameters<Commands["set"]>[1], entry = ""): Promise<void> {
    const outcome = await this.commands.set(name, settings);
    if (outcome.case === "refused" && outcome.value.field) this.entries.get(entry)?.refuse(refusalText(outcome.value));
    if (outcome.case !== "applied" && this.settings) this.setSettings(this.settings);
  }

  /** A number field that answers wrong entries. `below`: the element below which it does, else the field. */
  private number(id: string, controller: Controller, rule: () => EntryRule, below?: HTMLElement): NumberController {
    const tagged = tag(id, controller) as NumberController;
    this.entries.set(id, new Entry(tagged, rule, below));
    return tagged;
  }

  /** The setting that the user types or drags at present: messages of the server do not change it. */
  private edited(): string | undefined {
    const held = this.element.querySelector(".lil-slider.lil-active") ?? document.activeElement;
    const isEditing = held?.matches("input:not([type=checkbox]), .lil-slider");
    const control = isEditing && held?.closest<HTMLElement>("[data-control]");
    return control ? control.dataset.control?.replace("gravity-", "") : undefined;
  }

  private addSimulated(name: string): GUI {
    const folder = this.gui.addFolder(name);
    this.simulated.push(folder);
    return folder;
  }

  private addGravity(): void {
    const { world } = this;
    const folder = this.addSimulated("Gravity");
    folder.$children.append(this.arrowRoom);
    this.steering.push(folder);
    const setGravity = (entry?: string): void =>
      void this.change("Gravity", { gravity: [world.x, world.y, world.z] }, entry);
    const presetNames = [...Object.keys(gravityPresets), customGravity];
    const preset = tag("gravity-preset", folder.add(world, "gravity", presetNames).name("Preset, m/s²"));
    preset.onFinishChange((name: string) => {
      const gravity = gravityPresets[name];
      if (!gravity) return;
      [world.x, world.y, world.z] = gravity;
      setGravity();
    });
    const axes = ["x", "y", "z"] as const;
    const parts = axes.map((axis) => folder.add(world, axis).step(0.01).name(axis));
    parts.forEach((part, i) => {
      const id = `gravity-${axes[i]}`;
      const name = `${preset.$name.id} ${part.$name.id}`;
      part.domElement.querySelector("input")?.setAttribute("aria-labelledby", name);
      this.number(id, part, () => gravityRule, parts[2]?.domElement).onFinishChange(() => setGravity(id));
    });
  }

  private addWorld(): void {
    const { world } = this;
    const folder = this.gui.addFolder("World");
    this.playback = folder;
    this.steering.push(folder);
    folder.domElement.classList.add("playback");
    const add = (id: "restitution" | "friction" | "speed", [low, high, step]: number[], rule: EntryRule): void => {
      const name = rule.unit ? `${capital(id)}, ${rule.unit}` : capital(id);
      const control = this.number(id, folder.add(world, id, low, high, step).name(name), () => rule);
      control.onFinishChange((value: number) => void this.change(capital(id), { [id]: value }, id));
    };
    add("restitution", [0, 1, 0.01], { unit: "", least: 0, most: 1 });
    add("friction", [0, 1, 0.01], { unit: "", least: 0, most: 100 });
    add("speed", [0.05, 4, 0.05], { unit: "×", least: 0.001, most: 1000 });
  }

  private addQuality(): void {
    const { world } = this;
    const folder = this.addSimulated("Quality");
    this.steering.push(folder);
    folder.$children.append(this.dial.element);
    const setAuto = (): void => void this.change("Automatic", { auto: toAuto(world.auto, world.goal) }, "goal");
    const auto = tag("auto", folder.add(world, "auto", goalNames).name("Automatic"));
    auto.onFinishChange((name: GoalName) => {
      world.goal = goals[name].first;
      setAuto();
    });
    auto.domElement.title = "Adjusts the substeps to hold a step time or a mean overlap";
    this.goal = this.number("goal", folder.add(world, "goal").min(0).name(""), () => goals[world.auto].rule);
    this.goal.onFinishChange(setAuto).hide();
  }

  private addDrop(): void {
    const folder = this.addSimulated("Drop spheres");
    this.steering.push(folder);
    const countRule: EntryRule = { unit: "", whole: true, least: 1, most: 16_000_000 };
    this.number("drop-count", folder.add(this.drop, "count", 1, 5000, 1).name("Count"), () => countRule);
    const radius = folder.add(this.drop, "radius").min(0).name("Radius, m");
    this.number("drop-radius", radius, () => dropRadiusRule(this.facts));
    tag("drop", folder.add({ act: () => this.dropNow() }, "act").name("Drop"));
  }

  private addPush(): void {
    const folder = this.addSimulated("Click and drag");
    this.steering.push(folder);
    const tool = tag("tool", folder.add(this.choices, "tool", toolNames).name("Tool"));
    tool.domElement.title = "Select a sphere, push it, drag it by a spring, or drop spheres at the place of a click";
    const impulse = folder.add(this.choices, "impulse").min(0).name("Push, N s");
    impulse.domElement.title = impulseNote;
    this.number("impulse", impulse, () => impulseRule(this.settings));
  }

  private savePicture(): void {
    const sizes = ["picture-width", "picture-height"].map((id) => this.entries.get(id));
    if (sizes.every((size) => size?.check())) this.actions.savePicture(this.picture.width, this.picture.height);
  }

  private addLook(): void {
    const { actions, choices } = this;
    const folder = this.gui.addFolder("Look");
    const names = Object.fromEntries(modes.map((mode) => [quantityOf(mode).label, mode]));
    const mode = tag("colour", folder.add(choices, "mode", names).name("Colour by"));
    mode.onChange((value: Mode) => this.colourBy(value));
    const trace = tag("trace", folder.add(choices, "trace", { Shown: true, Hidden: false }).name("Path"));
    trace.domElement.title = "Shows the path of the selected sphere";
    this.rotation = tag("rotation", folder.add(choices, "rotation", rotationNames).name("Rotation"));
    this.rotation.domElement.title = "Shows how spheres turn. Automatic: in full quality, up to 10,000 spheres";
    const quality = tag("quality", folder.add(choices, "quality", qualityNames).name("Image quality"));
    quality.onChange((value: RenderQualityChoice) => actions.qualityChanged(value));
    const sizeRule: EntryRule = { unit: "px", whole: true, least: 16, most: largestSide };
    this.number("picture-width", folder.add(this.picture, "width", 16).name("Picture width, px"), () => sizeRule);
    this.number("picture-height", folder.add(this.picture, "height", 16).name("Picture height, px"), () => sizeRule);
    const save = tag("save-picture", folder.add({ act: () => this.savePicture() }, "act").name("Save picture"));
    save.domElement.title = "Saves what the page shows, without its controls, as a PNG file";
    const theme = tag("theme", folder.add(choices, "theme", themeNames).name("Theme"));
    theme.onChange((value: ThemeName) => actions.themeChanged(value));
  }
}
