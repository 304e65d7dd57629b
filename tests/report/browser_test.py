"""Opens report.html in headless Chromium and uses it as people do.

    browser_test.py MCDBN_CL [SCREENSHOT_FOLDER]

Makes motion, a tiny model and its report first. Exit code 77, which CTest takes for "skipped", where
there is no Chromium, no Selenium or no OpenCL device.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError:
    print("SKIPPED: Selenium is not installed (scripts/install_dependencies --test)")
    sys.exit(77)

TINY = (
    "--hidden 8 --mrbm-hidden 8 --phases 1 --gaussian-epochs 2 --mrbm-epochs 2 "
    "--fine-tuning-steps 30 --fine-tuning-windows 4 --augment-views 2"
).split()

# What the page's data begin with.
DATA = '<script type="application/json" id="data">'

# Whether anything is drawn, and a number that changes with what it is.
PICTURE = """
  const canvas = document.getElementById(arguments[0]), copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  const context = copy.getContext("2d", {willReadFrequently: true});
  context.drawImage(canvas, 0, 0);
  const pixels = context.getImageData(0, 0, copy.width, copy.height).data;
  let drawn = 0, sum = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 3] === 0) continue;
    ++drawn;
    sum = (sum * 31 + pixels[i] + 256 * pixels[i + 1] + 65536 * pixels[i + 2] + i) % 2147483647;
  }
  return [drawn, sum];
"""


def make_report(cli, folder):
    """Two actions, two people; the report tests on the second and, marked, on one of the first."""

    def run(*arguments):
        subprocess.run([cli, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)

    for action in ("walk", "clap"):
        run("synthesize", "--action", action, "--clips", 4, "--subjects", 2, "--seconds", 2,
            "-o", folder / action)
    clips = sorted(folder.glob("*/*.bvh"))
    train = [clip for clip in clips if "_s01_" in clip.name]
    test = [clip for clip in clips if "_s02_" in clip.name] + train[:1]
    run("train", *train, "-o", folder / "run", *TINY)
    # With noise in the tracks, so that there are errors and intervals to see.
    run("evaluate", "--model", folder / "run/model.safetensors", "--test", *test, "--samples", 2,
        "--track-noise-px", 3, "--actions", "by-folder", "--include-training", "--report",
        folder / "report")
    return folder / "report/report.html"


def start_browser(width=1280, height=900):
    options = Options()
    options.binary_location = shutil.which("chromium")
    for flag in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                 f"--window-size={width},{height}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


class ReportPage(unittest.TestCase):
    page = None
    shots = None

    @classmethod
    def setUpClass(cls):
        cls.browser = start_browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def setUp(self):
        self.browser.get(self.page.as_uri())

    def tearDown(self):
        self.assertEqual(self.browser.get_log("browser"), [], "the console is not empty")

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def picture(self, canvas="scene"):
        return self.browser.execute_script(PICTURE, canvas)

    def pixels_that_change_with(self, checkbox):
        """Of the scene, as it is clicked."""
        return self.browser.execute_script("""
          const canvas = document.getElementById("scene");
          const pixels = () => {
            const copy = document.createElement("canvas");
            [copy.width, copy.height] = [canvas.width, canvas.height];
            const context = copy.getContext("2d", {willReadFrequently: true});
            context.drawImage(canvas, 0, 0);
            return new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
          };
          const before = pixels();
          document.querySelector(arguments[0]).click();
          const after = pixels();
          return before.reduce((changed, pixel, i) => changed + (pixel !== after[i]), 0);""", checkbox)

    def viewer(self, name):
        return self.find(".viewer").get_attribute(f"data-{name}")

    def show(self, element):
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", element)

    def until(self, holds):
        """Waits as long as a busy machine may need."""
        WebDriverWait(self.browser, 60).until(lambda _: holds())

    def shoot(self, name):
        if self.shots:
            self.browser.save_screenshot(str(self.shots / f"{name}.png"))

    def press(self, *keys):
        ActionChains(self.browser).send_keys(*keys).perform()

    def test_canvases_are_not_blank(self):
        for canvas in ("scene", "input", "strip"):
            self.assertGreater(self.picture(canvas)[0], 300, canvas)
        self.shoot("light")

    def test_cards_name_who_is_ahead_by_the_figures_they_show(self):
        cards = self.all(".card:has(em)")
        self.assertEqual(len(cards), 4)
        for card in cards:
            figure, comparison = (card.find_element(By.TAG_NAME, tag).text for tag in ("b", "em"))
            word, theirs = re.fullmatch("(beats|behind|level with) .*: (.*)", comparison).groups()
            lead = float(re.match("[-.0-9]+", figure)[0]) - float(theirs)
            if "PCC" not in figure:
                lead = -lead
            wanted = "level with" if lead == 0 else "beats" if lead > 0 else "behind"
            self.assertEqual(word, wanted, f"{figure} {comparison}")

    def test_play_advances_and_pauses(self):
        play = self.find("#play")
        self.show(play)
        before = self.picture()[1]
        play.click()
        self.until(lambda: float(self.viewer("frame")) > 2)
        self.assertNotEqual(self.picture()[1], before)
        play.click()
        paused = self.viewer("frame")
        time.sleep(0.2)
        self.assertEqual(self.viewer("frame"), paused)

    def test_play_after_a_quick_pause_is_no_faster(self):
        pending = self.browser.execute_script("""
          const pending = new Set(), play = document.getElementById("play");
          const [request, cancel] = [window.requestAnimationFrame, window.cancelAnimationFrame];
          window.requestAnimationFrame = act => {
            const id = request(now => { pending.delete(id); act(now); });
            pending.add(id);
            return id;
          };
          window.cancelAnimationFrame = id => { pending.delete(id); cancel(id); };
          const counts = [];
          for (let i = 0; i < 6; ++i) {  // play, pause, play … before the next frame
            play.click();
            counts.push(pending.size);
          }
          return counts;""")
        self.assertEqual(pending, [1, 0, 1, 0, 1, 0])

    def test_a_held_space_key_counts_once(self):
        pressed = self.browser.execute_script("""
          const play = document.getElementById("play");
          return [false, true, true, false].map(repeat => {
            const event = new KeyboardEvent("keydown", {key: " ", repeat, bubbles: true, cancelable: true});
            document.body.dispatchEvent(event);
            return [play.getAttribute("aria-pressed"), event.defaultPrevented];
          });""")
        self.assertEqual([state for state, _ in pressed], ["true", "true", "true", "false"])
        self.assertTrue(all(prevented for _, prevented in pressed))  # the page does not scroll

    def test_without_a_clip_that_fits_there_is_no_player(self):
        text = self.page.read_text(encoding="utf-8")
        start = text.index(DATA) + len(DATA)
        end = text.index("</script>", start)
        data = json.loads(text[start:end])
        data |= {"clips": [], "omission": "The clips are too long."}
        page = self.page.with_name("no_player.html")
        page.write_text(text[:start] + json.dumps(data).replace("<", "\\u003c") + text[end:],
                        encoding="utf-8")
        self.browser.get(page.as_uri())
        self.assertFalse(self.find("#play").is_displayed())
        self.assertEqual(self.find("#omission").text, "The clips are too long.")
        self.assertGreater(len(self.all("#table-list details")), 0)

    def test_speed_changes_how_fast(self):
        def frames_played(speed):
            Select(self.find("#speed")).select_by_value(speed)
            return self.browser.execute_async_script("""
              const done = arguments[0], root = document.querySelector(".viewer");
              const scrub = document.getElementById("scrub");
              scrub.value = 0; scrub.dispatchEvent(new Event("input"));
              document.getElementById("play").click();
              const start = performance.now();
              setTimeout(() => {
                document.getElementById("play").click();
                done(+root.dataset.frame / (performance.now() - start));
              }, 400);""")

        self.assertGreater(frames_played("2"), 3 * frames_played("0.25"))

    def test_choosing_a_clip_or_a_sample_changes_it(self):
        first = self.picture()[1], self.viewer("clip")
        clips = Select(self.find("#clip"))
        self.assertEqual(len(clips.options), 5)
        clips.select_by_index(3)
        self.assertNotEqual(self.viewer("clip"), first[1])
        second = self.picture()[1]
        self.assertNotEqual(second, first[0])
        motions = Select(self.find("#motion"))
        labels = [option.get_attribute("data-label") for option in motions.options]
        self.assertEqual(labels[:3], ["mean field", "sample 1", "sample 2"])
        self.assertIn("ridge_window", labels)
        motions.select_by_index(2)
        self.assertNotEqual(self.picture()[1], second)

    def test_scrub_drag_and_zoom(self):
        seen = {self.picture()[1]}
        scrub = self.find("#scrub")
        self.show(scrub)
        ActionChains(self.browser).click(scrub).perform()
        self.assertGreater(float(self.viewer("frame")), 10)
        seen.add(self.picture()[1])
        scene = self.find("#scene")
        self.show(scene)
        ActionChains(self.browser).drag_and_drop_by_offset(scene, 120, 30).perform()
        seen.add(self.picture()[1])
        self.find("#closer").click()
        seen.add(self.picture()[1])
        self.assertEqual(len(seen), 4)

    def test_overlay_error_colours_and_alignment(self):
        clips = Select(self.find("#clip"))
        walks = [i for i, clip in enumerate(clips.options) if "walk_s02_02" in clip.text]
        clips.select_by_index(walks[0])  # its root is some millimetres off, so that alignment moves it
        seen = {self.picture()[1]}
        for selector in ("[value=overlay] + span", "#error", "#align"):
            self.show(self.find(selector))
            self.find(selector).click()
            seen.add(self.picture()[1])
        self.assertEqual(len(seen), 4)
        self.assertTrue(self.find("#legend").is_displayed())

    def test_intervals_are_shaded_where_the_answer_has_its_uncertainty(self):
        sure, motions = self.find("#sure"), Select(self.find("#motion"))
        self.assertEqual(self.viewer("motion"), "mean field")
        self.assertTrue(sure.is_enabled() and sure.is_selected())
        self.show(self.find("#scene"))
        self.shoot("intervals")
        shaded = self.picture()
        changed = self.pixels_that_change_with("#sure")
        self.assertGreater(changed, 0)
        self.assertNotEqual(self.picture(), shaded)
        self.press("u")
        self.assertEqual(self.picture(), shaded)
        # An answer that is less sure has more of it.
        self.browser.execute_script("""
          const drawn = Scene.prototype.intervals;
          Scene.prototype.intervals = function (panel, target, clip, points, deviations, colour) {
            drawn.call(this, panel, target, clip, points, deviations.map(d => d.map(mm => mm + 60)), colour);
          };""")
        sure.click()
        self.assertGreater(self.pixels_that_change_with("#sure"), changed + 300)
        motions.select_by_index(1)  # a sample has none
        self.assertFalse(sure.is_enabled())

    def test_an_interval_is_the_ellipse_that_its_deviations_make(self):
        # Seen from straight ahead: x to the right, y up; from the side z is to the left.
        ahead, aside, turned = self.browser.execute_script("""
          const orbit = new Orbit();
          const seen = (yaw, deviation) => {
            Object.assign(orbit, {yaw, pitch: 0});
            return orbit.ellipse(deviation);
          };
          return [seen(0, [30, 10, 500]), seen(Math.PI / 2, [500, 10, 70]), seen(Math.PI / 4, [40, 0, 40])];""")
        self.assertAlmostEqual(ahead["wide"], 30)
        self.assertAlmostEqual(ahead["narrow"], 10)
        self.assertAlmostEqual(ahead["angle"] % 3.141592653589793, 0)
        self.assertAlmostEqual(aside["wide"], 70)
        self.assertAlmostEqual(turned["wide"], 40)
        self.assertAlmostEqual(turned["narrow"], 0)

    def test_nine_of_ten_true_joints_are_in_the_shading_as_its_words_promise(self):
        self.assertIn("nine of ten true joints", self.find("label:has(#sure)").get_attribute("title"))
        # Of 20,000 normal draws around a joint in the middle of the panel 18,000 ± 42.
        share = self.browser.execute_script("""
          const scene = Object.create(Scene.prototype), ellipses = [];
          scene.orbit = Object.assign(new Orbit(), {yaw: .4, pitch: .3});
          scene.context = {beginPath() {}, moveTo() {}, fill() {},
                           ellipse(...of) { ellipses.push(of); }};
          const points = [[0, 900, 0], [100, 1300, 50]], deviation = [60, 20, 90];
          const panel = {x: 0, y: 0, width: 800, height: 600}, target = points[1];  // no perspective
          scene.intervals(panel, target, {parents: [-1, 0], joints: 2}, points, [deviation, deviation], "red");
          const [x, y, wide, narrow, turn] = ellipses.at(-1);  // at the joint itself
          let state = 1;
          const uniform = () => (state = state * 48271 % 2147483647) / 2147483647;
          const normal = () => Math.sqrt(-2 * Math.log(uniform())) * Math.cos(2 * Math.PI * uniform());
          let inside = 0;
          for (let i = 0; i < 20000; ++i) {
            const truth = points[1].map((value, axis) => value + deviation[axis] * normal());
            const seen = scene.orbit.project(truth, target, panel), [dx, dy] = [seen.x - x, seen.y - y];
            const along = dx * Math.cos(turn) + dy * Math.sin(turn), across = dy * Math.cos(turn) - dx * Math.sin(turn);
            inside += (along / wide) ** 2 + (across / narrow) ** 2 <= 1;
          }
          return inside / 20000;""")
        self.assertAlmostEqual(share, .9, delta=.01)

    def test_decoded_intervals_hold_as_many_truths_as_the_program_reports(self):
        # The page has whole millimetres: four rounded coordinates, and a deviation, are off by half of one each.
        least, most, reported = self.browser.execute_script("""
          const share = rounding => {
            const shares = report.clips.map(data => {
              const clip = new Clip(data), motion = clip.motion(0);
              let held = 0, all = 0;
              for (let joint = 1; joint < clip.joints; ++joint)
                for (let axis = 0; axis < 3; ++axis)
                  for (let frame = 0; frame < clip.frames; ++frame, ++all) {
                    const from = columns => columns[3 * joint + axis][frame] - columns[axis][frame];
                    held += Math.abs(from(motion.columns) - from(clip.truth))
                      <= 1.645 * (motion.deviations[3 * joint + axis][frame] + rounding / 2) + 2 * rounding;
                  }
              return held / all;
            });
            return shares.reduce((a, b) => a + b) / shares.length;
          };
          return [share(-1), share(1), report.summary.model_mean_field.within_90];""")
        self.assertLessEqual(least, reported)
        self.assertLessEqual(reported, most)
        self.assertGreater(least, 0)
        self.assertLess(most, 1)

    def test_keyboard(self):
        self.press(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_LEFT)
        self.assertEqual(float(self.viewer("frame")), 1)
        clip = self.viewer("clip")
        self.press("n")
        self.assertNotEqual(self.viewer("clip"), clip)
        self.press("p")
        self.assertEqual(self.viewer("clip"), clip)
        before = self.picture()[1]
        ActionChains(self.browser).key_down(Keys.SHIFT).send_keys(Keys.ARROW_LEFT).key_up(
            Keys.SHIFT).perform()
        self.assertNotEqual(self.picture()[1], before)
        self.press("o", "e", "]", "+")
        self.assertTrue(self.find("[value=overlay]").is_selected())
        self.assertTrue(self.find("#error").is_selected())
        self.assertEqual(self.find("#speed").get_attribute("value"), "2")
        self.press(" ")
        self.until(lambda: float(self.viewer("frame")) > 1)

    def test_decoded_motion_scores_as_the_program_does(self):
        # Not the same mean: the page holds whole millimetres.
        shown, reported = self.browser.execute_script("""
          const clip = new Clip(report.clips[1]), motion = clip.motion(1);
          return [motion.errors.reduce((a, b) => a + b) / clip.frames, motion.mpjpe_mm];""")
        self.assertLess(abs(shown - reported), 1.0)

    def test_figures_and_tables(self):
        self.assertEqual(len(self.all("#figure-list svg")), 8)
        self.assertGreater(len(self.all("#figure-list svg path.curve")), 8)
        self.assertGreater(len(self.all("#figure-list svg rect")), 8)
        for path in self.all("#figure-list svg path.curve"):
            self.assertNotIn("NaN", path.get_attribute("d"))
        self.assertEqual(len(self.all("#table-list details")), 9)
        self.assertGreater(len(self.all("#verdicts li")), 4)
        marked = [row.text for row in self.all("#table-list .mark")]
        self.assertGreater(len(marked), 0)

    def test_tables_sort(self):
        table = next(t for t in self.all("#table-list details") if "table_3.csv" in t.text)
        column = next(i for i, th in enumerate(table.find_elements(By.CSS_SELECTOR, "th"))
                      if th.text.startswith("mean"))
        head = table.find_elements(By.CSS_SELECTOR, "th")[column]
        self.show(head)

        def values():
            return [float(row.find_elements(By.CSS_SELECTOR, "td")[column].text)
                    for row in table.find_elements(By.CSS_SELECTOR, "tbody tr")]

        head.click()
        self.assertEqual(values(), sorted(values()))
        head.click()
        self.assertEqual(values(), sorted(values(), reverse=True))
        self.assertGreater(len(set(values())), 1)

    def test_dark_and_light(self):
        def background():
            return self.browser.execute_script(
                "return getComputedStyle(document.body).backgroundColor")

        light, picture = background(), self.picture()[1]
        self.find("#theme").click()
        self.until(lambda: background() != light and self.picture()[1] != picture)
        self.shoot("dark")
        self.find("#theme").click()
        self.assertEqual(background(), light)

    def test_touch_turns(self):
        scene = self.find("#scene")
        self.show(scene)
        before = self.picture()[1]
        x, y = scene.rect["x"], self.browser.execute_script(
            "return arguments[0].getBoundingClientRect().top", scene)
        self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True})
        try:
            for kind, points in (("touchStart", [(200, 100)]), ("touchMove", [(230, 102)]),
                                 ("touchMove", [(300, 104)]), ("touchEnd", [])):
                self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {
                    "type": kind, "touchPoints": [{"x": x + a, "y": y + b} for a, b in points]})
            self.assertNotEqual(self.picture()[1], before)
        finally:
            self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})

    def test_phone(self):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True})
        try:
            self.browser.get(self.page.as_uri())
            width = self.browser.execute_script("return document.documentElement.scrollWidth")
            self.assertLessEqual(width, 390)
            self.assertGreater(self.picture()[0], 300)
            for selector in ("#play", "#clip", "#motion", "#scrub"):
                self.assertGreater(self.find(selector).size["height"], 20, selector)
            self.find(".viewer").location_once_scrolled_into_view
            self.shoot("phone")
        finally:
            self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def test_needs_no_network(self):
        asked = self.browser.execute_script(
            "return performance.getEntriesByType('resource').map(entry => entry.name)")
        self.assertEqual([name for name in asked if not name.startswith("data:")], [])


def main():
    cli = sys.argv[1]
    if len(sys.argv) > 2:
        ReportPage.shots = pathlib.Path(sys.argv[2])
    for program in ("chromium", "chromedriver"):
        if not shutil.which(program):
            print(f"SKIPPED: no {program} (scripts/install_dependencies --test)")
            sys.exit(77)
    if subprocess.run([cli, "devices"], capture_output=True, check=False).returncode != 0:
        print("SKIPPED: no OpenCL device here")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        ReportPage.page = make_report(cli, pathlib.Path(folder))
        unittest.main(argv=sys.argv[:1])


if __name__ == "__main__":
    main()
