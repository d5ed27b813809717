using UnrealBuildTool;

public class MetagraphEditor : ModuleRules
{
	public MetagraphEditor(ReadOnlyTargetRules Target) : base(Target)
	{
		PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
		PublicDependencyModuleNames.AddRange(new string[] { "Core", "CoreUObject", "Engine", "Metagraph", "AnimGraph", "BlueprintGraph" });
		PrivateDependencyModuleNames.AddRange(new string[] { "UnrealEd", "AnimGraphRuntime" });
	}
}
