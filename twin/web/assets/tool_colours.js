/** What each tool has cut is coloured so, by the tool's number; told apart also by who sees no red (Okabe and Ito). */
export const TOOL_COLOURS = ["#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7"];
