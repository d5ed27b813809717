using System.IO;
using UnrealBuildTool;

public class Metagraph : ModuleRules
{
	public Metagraph(ReadOnlyTargetRules Target) : base(Target)
	{
		PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
		CppStandard = CppStandardVersion.Cpp17;
		bEnableExceptions = false; // the core needs neither these
		bUseRTTI = false; // nor run-time types
		PublicDependencyModuleNames.AddRange(new string[] { "Core", "CoreUObject", "Engine" });
		PrivateIncludePaths.Add(Path.Combine(ModuleDirectory, "Private", "Core"));
	}
}
