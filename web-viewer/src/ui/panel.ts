import GUI from "lil-gui";
import type { Controller } from "lil-gui";
import type { Commands } from "../connection/commands";
import type { ViewRequest } from "../connection/messages";
import type { Diagnostics, Dial as DialMessage, Settings } from "../gen/spherule/v1/control_pb";
import type { Facts } from "../model/facts";
import { defaultMode, modes, quantityOf } from "../model/quantities";
import type { Mode } from "../model/quantities";
import type { RenderQualityChoice } from "../renderer/render_quality";
import type { ThemeName } from "../renderer/theme";
import { fromAuto, goalNames, goals, toAuto } from "./auto_goal";
import type { GoalName } from "./auto_goal";
import { Restriction, tag } from "./controllers";
import { Dial } from "./dial";
import { rememberFolders } from "./folders";
import { customGravity, gravityPresetOf, gravityPresets } from "./presets";
import { dropCountFor, dropFor, impulseFor, impulseNote } from "./presets";
import { StatisticsLists } from "./statistics";
import { StreamFolder } from "./stream_folder";

/** Choices of the user that concern only this page. */
export interface Choices {
  mode: Mode;
  modeChosen: boolean; // false: the scene determines the mode
  quality: RenderQualityChoice;
  theme: ThemeName;
  push: boolean;
  impulse: number; // N s
  view: ViewRequest;
}

export interface PanelActions {
  themeChanged(theme: ThemeName): void;
  qualityChanged(quality: RenderQualityChoice): void;
  viewRequested(view: ViewRequest): void;
  forgetToken(): void;
  showScenes(): void;
}

const qualityNames = { Automatic: "auto", Full: "full", Light: "light" };
const themeNames = { Light: "light", Dark: "dark" };

/**
 * The panel at the side. It sends a command when a control is released, and shows the settings that the server reports.
 */
export class Panel {
  readonly element: HTMLElement;
  readonly stream: StreamFolder;
  private readonly gui: GUI;
  private readonly statistics = new StatisticsLists();
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
  private readonly drop = { count: 200, radius: 0.05 };
  private readonly steering: GUI[] = []; // folders whose controls send commands
  private readonly simulated: GUI[] = []; // folders that are hidden for a recording
  private playback!: GUI; // the folder of which a recording uses the speed
  private readonly access: GUI; // hidden while there is no token
  private readonly restriction: Restriction;
  private readonly scenes: Controller;
  private readonly dial = new Dial(
    ({ model, substeps, own }) => void this.change("Quality", own ? { model } : { model, substeps }),
  );
  private goal!: Controller;
  private facts: Facts | undefined;
  private settings: Settings | undefined;

  constructor(
    private readonly commands: Commands,
    readonly choices: Choices,
    private readonly actions: PanelActions,
  ) {
    this.gui = new GUI({ autoPlace: false, injectStyles: false, title: "Controls", width: 288 });
    this.element = this.gui.domElement;
    this.element.dataset.testid = "panel";
    this.scenes = tag("scenes", this.gui.add({ act: () => actions.showScenes() }, "act").name("Scenes…"));
    this.addDrop();
    this.addPush();
    this.addGravity();
    this.addQuality();
    this.addWorld();
    this.addLook();
    const requested = (view: ViewRequest): void => actions.viewRequested(view);
    const stream = this.gui.addFolder("Stream");
    this.stream = new StreamFolder(stream, choices.view, requested);
    const now = this.addSimulated("Now");
    now.$children.append(this.statistics.quality.element);
    const statistics = this.addSimulated("Statistics");
    statistics.$children.append(this.statistics.rest.element);
    this.access = this.gui.addFolder("Access").hide();
    const forget = this.access.add({ act: () => actions.forgetToken() }, "act").name("Forget token");
    tag("forget-token", forget).domElement.title = "This tab remembers the token until it is closed";
    rememberFolders(this.gui, [stream, now, statistics], () => localStorage);
    this.restriction = new Restriction(this.steering.flatMap((folder) => folder.controllers));
  }

  /** Disables all controls that send commands; an empty reason enables them. */
  restrict(blockedReason: string): void {
    if (blockedReason) this.choices.push = false;
    this.restriction.set(blockedReason);
    this.dial.restrict(blockedReason);
    this.refresh();
  }

  setTokenHeld(held: boolean): void {
    this.access.show(held);
  }

  /** `playing`: the server plays a recording. Hides the controls that then have no effect. */
  setPlaying(playing: boolean): void {
    if (playing) this.choices.push = false;
    this.scenes.show(!playing);
    for (const folder of this.simulated) folder.show(!playing);
    for (const controller of this.playback.controllers) controller.show(!playing || controller.property === "speed");
    this.playback.title(playing ? "Recording" : "World");
    this.refresh();
  }

  setFacts(facts: Facts): void {
    const otherScene = facts.name !== this.facts?.name;
    this.facts = facts;
    if (otherScene) {
      this.drop.radius = Number((facts.population.meanRadius || 0.05).toPrecision(2));
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
    this.dial.setSettings(settings);
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
    if (this.facts) void this.commands.drop(dropFor(this.facts, this.drop.count, this.drop.radius));
  }

  /** Sends a change of settings. If the server refuses it, the control returns to the present setting. */
  private async change(name: string, settings: Parameters<Commands["set"]>[1]): Promise<void> {
    const outcome = await this.commands.set(name, settings);
    if (outcome.case !== "applied" && this.settings) this.setSettings(this.settings);
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
    this.steering.push(folder);
    const setGravity = (): void => void this.change("Gravity", { gravity: [world.x, world.y, world.z] });
    const presetNames = [...Object.keys(gravityPresets), customGravity];
    const preset = tag("gravity-preset", folder.add(world, "gravity", presetNames).name("Preset, m/s²"));
    preset.onFinishChange((name: string) => {
      const gravity = gravityPresets[name];
      if (!gravity) return;
      [world.x, world.y, world.z] = gravity;
      setGravity();
    });
    for (const axis of ["x", "y", "z"] as const) {
      const part = folder.add(world, axis).step(0.01).decimals(2).name(axis);
      tag(`gravity-${axis}`, part).onFinishChange(setGravity);
    }
  }

  private addWorld(): void {
    const { world } = this;
    const folder = this.gui.addFolder("World");
    this.playback = folder;
    this.steering.push(folder);
    folder.domElement.classList.add("playback");
    tag("restitution", folder.add(world, "restitution", 0, 1, 0.01).name("Restitution")).onFinishChange(
      (restitution: number) => void this.change("Restitution", { restitution }),
    );
    tag("friction", folder.add(world, "friction", 0, 1, 0.01).name("Friction")).onFinishChange(
      (friction: number) => void this.change("Friction", { friction }),
    );
    tag("speed", folder.add(world, "speed", 0.05, 4, 0.05).name("Speed, ×")).onFinishChange(
      (speed: number) => void this.change("Speed", { speed }),
    );
  }

  private addQuality(): void {
    const { world } = this;
    const folder = this.addSimulated("Quality");
    this.steering.push(folder);
    folder.$children.append(this.dial.element);
    const setAuto = (): void => void this.change("Automatic", { auto: toAuto(world.auto, world.goal) });
    const auto = tag("auto", folder.add(world, "auto", goalNames).name("Automatic"));
    auto.onFinishChange((name: GoalName) => {
      world.goal = goals[name].first;
      setAuto();
    });
    auto.domElement.title = "Adjusts the substeps to hold a step time or a mean overlap";
    this.goal = tag("goal", folder.add(world, "goal").min(0).decimals(3).name("")).onFinishChange(setAuto).hide();
  }

  private addDrop(): void {
    const folder = this.addSimulated("Drop spheres");
    this.steering.push(folder);
    tag("drop-count", folder.add(this.drop, "count", 1, 5000, 1).name("Count"));
    tag("drop-radius", folder.add(this.drop, "radius").min(1e-4).decimals(4).name("Radius, m"));
    tag("drop", folder.add({ act: () => this.dropNow() }, "act").name("Drop"));
  }

  private addPush(): void {
    const folder = this.addSimulated("Push");
    this.steering.push(folder);
    tag("push", folder.add(this.choices, "push").name("Push on click"));
    tag("impulse", folder.add(this.choices, "impulse").min(0).name("Impulse, N s")).domElement.title = impulseNote;
  }

  private addLook(): void {
    const { actions, choices } = this;
    const folder = this.gui.addFolder("Look");
    const names = Object.fromEntries(modes.map((mode) => [quantityOf(mode).label, mode]));
    const mode = tag("colour", folder.add(choices, "mode", names).name("Colour by"));
    mode.onChange((value: Mode) => this.colourBy(value));
    const quality = tag("quality", folder.add(choices, "quality", qualityNames).name("Image quality"));
    quality.onChange((value: RenderQualityChoice) => actions.qualityChanged(value));
    const theme = tag("theme", folder.add(choices, "theme", themeNames).name("Theme"));
    theme.onChange((value: ThemeName) => actions.themeChanged(value));
  }
}
